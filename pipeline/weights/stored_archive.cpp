#include "pipeline/weights/stored_archive.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "collision/geometry/error.hpp"

namespace selvedge {
namespace {

constexpr std::uint64_t largest_directory = std::uint64_t{16} << 20, largest_entry = std::uint64_t{256} << 20,
                        most_read = std::uint64_t{1} << 30, most_entries = 100'000;
constexpr std::size_t end_size = 22, end64_size = 56, locator_size = 20, entry_size = 46, header_size = 30;

bool has_signature(std::string_view bytes, std::size_t at, std::string_view signature) {
  return at <= bytes.size() && bytes.substr(at, 4) == signature;
}

// CRC-32 of ZIP: polynomial 0xEDB88320, bits reversed.
std::uint32_t checksum_of(std::string_view bytes) {
  static const std::array<std::uint32_t, 256> table = [] {
    std::array<std::uint32_t, 256> made{};
    for (std::uint32_t k = 0; k < 256; ++k) {
      made[k] = k;
      for (int bit = 0; bit < 8; ++bit) made[k] = made[k] >> 1 ^ (made[k] & 1 ? 0xEDB88320U : 0U);
    }
    return made;
  }();
  std::uint32_t sum = ~0U;
  for (const char byte : bytes) sum = sum >> 8 ^ table[(sum ^ static_cast<unsigned char>(byte)) & 0xFF];
  return ~sum;
}

struct DirectoryPlace {
  std::uint64_t at, size, count;
};

// The place of the end record in the last bytes of a file. A comment of the stated length follows it.
std::size_t find_end_record(std::string_view tail) {
  for (std::size_t from = tail.size(); from >= end_size; --from) {
    const std::size_t at = from - end_size;
    if (has_signature(tail, at, "PK\5\6") && number_at(tail, at + 20, 2) == tail.size() - at - end_size) return at;
  }
  return std::string_view::npos;
}

// Takes size, packed size and offset from the entry's ZIP64 record where the 32-bit fields refer to it.
void read_wide_fields(std::string_view extra, std::array<std::uint64_t*, 3> fields) {
  for (std::size_t at = 0; at + 4 <= extra.size();) {
    const std::uint64_t id = number_at(extra, at, 2), length = number_at(extra, at + 2, 2);
    at += 4;
    if (length > extra.size() - at) return;
    std::size_t from = at;
    if (id == 1)
      for (std::uint64_t* field : fields)
        if (*field == 0xFFFFFFFF && from + 8 <= at + length) {
          *field = number_at(extra, from, 8);
          from += 8;
        }
    at += length;
  }
}

}  // namespace

std::uint64_t number_at(std::string_view bytes, std::size_t at, std::size_t count) {
  std::uint64_t value = 0;
  for (std::size_t k = 0; k < count; ++k) value |= std::uint64_t{static_cast<unsigned char>(bytes[at + k])} << (8 * k);
  return value;
}

void StoredArchive::fail(const std::string& what) const {
  std::string line = what;  // names of entries come from the file
  std::ranges::replace_if(
      line, [](char c) { return c < ' ' || c > '~'; }, '?');
  throw Error(line, path_.string(), "the file is damaged, incomplete or not made by torch.save; copy or save it again");
}

std::string StoredArchive::read(std::uint64_t at, std::uint64_t count) {
  if (at > size_ || count > size_ - at) fail("is cut short: parts of it would lie after its end");
  std::string bytes(count, '\0');
  file_.seekg(static_cast<std::streamoff>(at));
  if (!file_.read(bytes.data(), static_cast<std::streamsize>(count))) fail("cannot be read");
  return bytes;
}

StoredArchive::StoredArchive(const std::filesystem::path& path) : path_(path) {
  std::error_code problem;
  if (!std::filesystem::is_regular_file(path, problem)) throw Error("is no file", path.string(), "check the path");
  size_ = std::filesystem::file_size(path, problem);
  if (problem) throw Error("cannot be opened (" + problem.message() + ")", path.string(), "check the path");
  file_.open(path, std::ios::binary);
  if (!file_) throw Error("cannot be opened", path.string(), "check the path and the rights");

  // The end record is followed by a comment of at most 65,535 bytes.
  const std::uint64_t tail_at = size_ - std::min<std::uint64_t>(size_, end_size + 0xFFFF);
  const std::string tail = read(tail_at, size_ - tail_at);
  const std::size_t end = find_end_record(tail);
  if (end == std::string::npos)
    throw Error(
        "is no ZIP archive", path.string(),
        "is it a file of torch.save, and whole? Load and save older ones (before torch 1.6) again with a newer");
  DirectoryPlace place{number_at(tail, end + 16, 4), number_at(tail, end + 12, 4), number_at(tail, end + 10, 2)};
  std::uint64_t bound = tail_at + end;
  if (end >= locator_size && has_signature(tail, end - locator_size, "PK\6\7")) {
    const std::uint64_t record_at = number_at(tail, end - locator_size + 8, 8);
    const std::string record = read(record_at, end64_size);
    if (!has_signature(record, 0, "PK\6\6")) fail("has a ZIP64 locator that leads nowhere");
    place = {number_at(record, 48, 8), number_at(record, 40, 8), number_at(record, 32, 8)};
    bound = record_at;
  }
  if (place.count > most_entries) fail(fmt::format("claims {} entries; {} are the most", place.count, most_entries));
  if (place.size > largest_directory)
    fail(fmt::format("claims a directory of {} bytes; {} are the most", place.size, largest_directory));
  if (place.at > bound || place.size > bound - place.at) fail("has a directory that does not lie before its end");
  directory_at_ = place.at;
  read_directory(read(place.at, place.size), place.count);
}

void StoredArchive::read_directory(const std::string& directory, std::uint64_t count) {
  std::size_t at = 0;
  for (std::uint64_t k = 0; k < count; ++k) {
    if (directory.size() - at < entry_size || !has_signature(directory, at, "PK\1\2"))
      fail(fmt::format("has a damaged directory: entry {} of {} is missing", k + 1, count));
    const std::uint64_t flags = number_at(directory, at + 8, 2), method = number_at(directory, at + 10, 2);
    StoredEntry entry{number_at(directory, at + 42, 4), number_at(directory, at + 24, 4),
                      static_cast<std::uint32_t>(number_at(directory, at + 16, 4))};
    std::uint64_t packed = number_at(directory, at + 20, 4);
    const std::uint64_t name_size = number_at(directory, at + 28, 2), extra_size = number_at(directory, at + 30, 2),
                        comment_size = number_at(directory, at + 32, 2);
    at += entry_size;
    if (name_size + extra_size + comment_size > directory.size() - at) fail("has a damaged directory");
    const std::string name = directory.substr(at, name_size);
    read_wide_fields(std::string_view(directory).substr(at + name_size, extra_size),
                     {&entry.size, &packed, &entry.header_at});
    at += name_size + extra_size + comment_size;
    if ((flags & 1) != 0) fail("has an encrypted entry, number " + std::to_string(k + 1));
    if (method != 0)
      fail(fmt::format("has a compressed entry, number {} (method {}); torch.save does not compress", k + 1, method));
    if (packed != entry.size) fail(fmt::format("claims {} bytes of {} stored ones", entry.size, packed));
    if (!entries_.emplace(name, entry).second) fail(fmt::format("has two entries of one name, number {}", k + 1));
  }
  if (at != directory.size()) fail("has a directory with more entries than it states");
}

std::vector<std::string> StoredArchive::names() const {
  std::vector<std::string> names;
  for (const auto& [name, entry] : entries_) names.push_back(name);
  return names;
}

std::string StoredArchive::bytes(const std::string& name) {
  const auto found = entries_.find(name);
  if (found == entries_.end()) fail("has no entry " + name);
  const StoredEntry& entry = found->second;
  if (entry.size > largest_entry)
    fail(fmt::format("claims {} bytes for {}; {} are the most", entry.size, name, largest_entry));
  read_ += entry.size;
  if (read_ > most_read) fail(fmt::format("holds more than the {} bytes that are read at most", most_read));
  const std::string header = read(entry.header_at, header_size);
  if (!has_signature(header, 0, "PK\3\4") || number_at(header, 8, 2) != 0)
    fail("has a damaged entry " + name + ": its header is missing");
  const std::uint64_t name_size = number_at(header, 26, 2), extra_size = number_at(header, 28, 2);
  if (read(entry.header_at + header_size, name_size) != name)
    fail("has a damaged entry " + name + ": its header has another name");
  const std::uint64_t from = entry.header_at + header_size + name_size + extra_size;
  if (from > directory_at_ || entry.size > directory_at_ - from)
    fail("has a damaged entry " + name + ": it does not lie before the directory");
  std::string content = read(from, entry.size);
  if (checksum_of(content) != entry.checksum) fail("has a damaged entry " + name + ": its checksum is wrong");
  return content;
}

}  // namespace selvedge
