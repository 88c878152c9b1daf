#include "pipeline/processes/together.hpp"

#include <algorithm>
#include <array>
#include <cstring>

#include <fmt/format.h>

namespace selvedge {
namespace {

// What a process is about to do.
enum class Intent : std::uint64_t { fail, add_floats, add_doubles, gather, wait };
struct Announcement {
  Intent intent;
  std::uint64_t size;  // numbers; bytes of the message for `fail`
};

template <class T>
std::vector<T> gather_values(Processes& processes, const T& mine) {
  std::vector<T> all(static_cast<std::size_t>(processes.count()));
  processes.gather(std::as_bytes(std::span(&mine, 1)), std::as_writable_bytes(std::span(all)));
  return all;
}

constexpr std::size_t longest_message = 16384;

// Problem, place and cure in one text.
std::string packed(const std::exception& failure) {
  std::string text;
  if (const auto* error = dynamic_cast<const Error*>(&failure))
    text = error->problem() + '\0' + error->where() + '\0' + error->cure();
  else
    text = std::string(failure.what()) + '\0' + '\0';
  return text.substr(0, longest_message);
}

SharedFailure unpacked(const std::string& text, int rank) {
  std::array<std::string, 3> parts;
  std::size_t at = 0;
  for (std::string& part : parts) {
    const std::size_t end = std::min(text.find('\0', at), text.size());
    part = text.substr(std::min(at, text.size()), end - std::min(at, text.size()));
    at = end + 1;
  }
  auto& [problem, where, cure] = parts;
  const std::string who = fmt::format("process {}", rank);
  return {problem, rank == 0 ? where : where.empty() ? who : who + ": " + where, cure};
}

// Every process calls this once one of them has failed; `mine` is empty where it is another. Throws.
[[noreturn]] void throw_first_failure(Processes& processes, const std::vector<Announcement>& all,
                                      const std::string& mine) {
  std::size_t longest = 0;
  for (const Announcement& one : all)
    if (one.intent == Intent::fail) longest = std::max(longest, static_cast<std::size_t>(one.size));
  std::vector<std::byte> block(longest), blocks(longest * all.size());
  std::memcpy(block.data(), mine.data(), mine.size());
  processes.gather(block, blocks);
  const auto first = std::ranges::find(all, Intent::fail, &Announcement::intent) - all.begin();
  const auto* begin = reinterpret_cast<const char*>(blocks.data()) + static_cast<std::size_t>(first) * longest;
  throw unpacked({begin, static_cast<std::size_t>(all[static_cast<std::size_t>(first)].size)}, static_cast<int>(first));
}

// Throws SharedFailure on all processes unless all are about to do this.
void announce(Processes& processes, Intent intent, std::size_t size) {
  const std::vector<Announcement> all = gather_values(processes, Announcement{intent, size});
  if (std::ranges::find(all, Intent::fail, &Announcement::intent) != all.end()) throw_first_failure(processes, all, "");
  if (std::ranges::any_of(all, [&](const Announcement& one) {
        return one.intent != all.front().intent || one.size != all.front().size;
      }))
    throw SharedFailure("the processes do not do the same", "the processes of mpirun",
                        "start all of them with one command and one program");
}

// Each process gets its part of the numbers from all, adds it up, and gives the sum to all. Parts are equally long;
// behind the last number stand zeros.
template <class T>
void add_by_parts(Processes& processes, std::span<T> numbers) {
  const auto count = static_cast<std::size_t>(processes.count());
  const std::size_t part = (numbers.size() + count - 1) / count;
  if (part == 0) return;
  std::vector<T> all(part * count, T(0)), got(part * count);
  std::ranges::copy(numbers, all.begin());
  processes.exchange(std::as_bytes(std::span(all)), std::as_writable_bytes(std::span(got)));
  for (std::size_t rank = 1; rank < count; ++rank)
    for (std::size_t k = 0; k < part; ++k) got[k] += got[rank * part + k];
  processes.gather(std::as_bytes(std::span(got).first(part)), std::as_writable_bytes(std::span(all)));
  std::copy_n(all.begin(), numbers.size(), numbers.begin());
}

}  // namespace

void add_up(Processes& processes, std::span<float> numbers) {
  announce(processes, Intent::add_floats, numbers.size());
  add_by_parts(processes, numbers);
}

void add_up(Processes& processes, std::span<double> numbers) {
  announce(processes, Intent::add_doubles, numbers.size());
  add_by_parts(processes, numbers);
}

std::vector<std::uint64_t> gathered(Processes& processes, std::uint64_t number) {
  announce(processes, Intent::gather, 1);
  return gather_values(processes, number);
}

void check_same(Processes& processes, std::uint64_t number, const std::string& what, const std::string& where,
                const std::string& cure) {
  const std::vector<std::uint64_t> all = gathered(processes, number);
  const auto other = std::ranges::find_if(all, [&](std::uint64_t one) { return one != all.front(); });
  if (other != all.end())
    throw SharedFailure(fmt::format("processes 0 and {} have different {}", other - all.begin(), what), where, cure);
}

void wait_for_all(Processes& processes) { announce(processes, Intent::wait, 0); }

void share_failure(Processes& processes, const std::exception& failure) {
  const std::string message = packed(failure);
  throw_first_failure(processes, gather_values(processes, Announcement{Intent::fail, message.size()}), message);
}

}  // namespace selvedge
