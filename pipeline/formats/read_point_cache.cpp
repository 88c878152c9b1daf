#include "pipeline/formats/read_point_cache.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>

#include "collision/geometry/error.hpp"
#include "pipeline/formats/half_float.hpp"
#include "pipeline/host/bounds.hpp"
#include "pipeline/host/lower_extension.hpp"
#include "pipeline/host/read_file.hpp"

namespace selvedge {
namespace {

static_assert(std::endian::native == std::endian::little, "MDD is read by turning its bytes round");

constexpr double most_time = 1e6;  // of a sample [frames or s]: beyond it floats are too coarse
constexpr double uneven = 0.01;    // steps that differ by more are not a steady rate

// The numbers of a cache one after the other.
struct CacheBytes {
  std::string file, bytes;
  bool big_endian = false, half = false;
  std::size_t at = 0;

  [[noreturn]] void fail(const std::string& what, const std::string& cure) const { throw Error(what, file, cure); }

  template <class Value>
  Value next() {
    char raw[sizeof(Value)];
    if (bytes.size() - at < sizeof raw) fail("ends within its header", "write it anew: it is cut short");
    std::memcpy(raw, bytes.data() + at, sizeof raw);
    at += sizeof raw;
    if (big_endian) std::reverse(raw, raw + sizeof raw);
    Value value;
    std::memcpy(&value, raw, sizeof raw);
    return value;
  }

  double coordinate() { return half ? half_value(next<std::uint16_t>()) : next<float>(); }

  void check_size(std::int32_t points, std::int32_t frames, std::size_t head) const {
    if (points < 1 || frames < 1)
      fail(fmt::format("has {} points and {} frames", points, frames), "write one of each at least");
    const double whole = static_cast<double>(head) + (half ? 2.0 : 4.0) * 3 * points * frames;
    if (whole != static_cast<double>(bytes.size()))
      fail(fmt::format("has {} bytes, {} points in {} frames take {:.0f}", bytes.size(), points, frames, whole),
           half ? "write it anew, as half floats: it is cut short, or has others"
                : "write it anew, as 32-bit floats: it is cut short, or has others");
    refuse_too_many(3.0 * points * frames, most_numbers, "coordinates", file, "write fewer points or frames");
  }

  std::vector<Points> read(std::int32_t points, std::int32_t frames) {
    std::vector<Points> all;
    for (std::int32_t f = 0; f < frames; ++f) {
      Points x(points, 3);
      for (Eigen::Index i = 0; i < x.size(); ++i) {
        x.data()[i] = coordinate();
        if (!std::isfinite(x.data()[i]))
          fail(fmt::format("is not finite at vertex {} of frame {}", i / 3, f), "repair it where it was made");
      }
      all.push_back(std::move(x));
    }
    return all;
  }
};

void check_ascending(const CacheBytes& file, const std::vector<double>& times) {
  for (std::size_t f = 1; f < times.size(); ++f)
    if (!(times[f] > times[f - 1]))
      file.fail(fmt::format("has sample {} at {}, after one at {}", f, times[f], times[f - 1]),
                "write its samples in the order of time, each at its own");
}

PointCache read_pc2(CacheBytes file) {
  const std::string head("POINTCACHE2\0", 12);
  if (!file.bytes.starts_with(head)) file.fail("does not begin with POINTCACHE2", "give a .pc2 or .pc16 file");
  file.at = head.size();
  if (const auto version = file.next<std::int32_t>(); version != 1)
    file.fail(fmt::format("has version {}", version), "write version 1, which alone is read");
  const auto points = file.next<std::int32_t>();
  const double first = file.next<float>(), sampling = file.next<float>();
  const auto frames = file.next<std::int32_t>();
  file.check_size(points, frames, file.at);
  if (!(std::abs(first) <= most_time))
    file.fail(fmt::format("starts at frame {}", first), fmt::format("write a start frame of {:g} at most", most_time));
  if (frames > 1 && !(sampling > 0 && sampling <= most_time))
    file.fail(fmt::format("has a sampling rate of {} frames a sample", sampling), "write a number above 0");
  PointCache cache;
  for (std::int32_t f = 0; f < frames; ++f) cache.at.push_back(f == 0 ? first : first + f * sampling);
  check_ascending(file, cache.at);
  cache.frames = file.read(points, frames);
  return cache;
}

// Sets the times of a cache, given in [s]: as frames of their rate if it is steady, else unchanged.
void set_times(const CacheBytes& file, const std::vector<double>& times, PointCache& cache) {
  for (const double time : times)
    if (!(std::abs(time) <= most_time))
      file.fail(fmt::format("has the time {} s", time), fmt::format("write times of {:g} s at most", most_time));
  check_ascending(file, times);
  cache.at = times;
  if (times.size() == 1) return;
  const double step = (times.back() - times.front()) / static_cast<double>(times.size() - 1);
  cache.fps = 1;
  for (std::size_t f = 0; f < times.size(); ++f)
    if (!(std::abs(times[f] - times.front() - static_cast<double>(f) * step) <= uneven * step)) return;
  cache.fps = 1 / step;
  const double first = std::round(1e4 * times.front() / step) / 1e4;  // the precision of floats
  for (std::size_t f = 0; f < times.size(); ++f) cache.at[f] = first + static_cast<double>(f);
}

PointCache read_mdd(CacheBytes file) {
  const auto frames = file.next<std::int32_t>(), points = file.next<std::int32_t>();
  file.check_size(points, frames, 8 + 4 * static_cast<std::size_t>(std::max(frames, 0)));
  std::vector<double> times;
  for (std::int32_t f = 0; f < frames; ++f) times.push_back(file.next<float>());
  PointCache cache;
  set_times(file, times, cache);
  cache.frames = file.read(points, frames);
  return cache;
}

}  // namespace

PointCache read_point_cache(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  CacheBytes file{path.string(), read_file(path, "point cache"), extension == ".mdd", extension == ".pc16"};
  if (extension == ".mdd") return read_mdd(std::move(file));
  if (extension == ".pc2" || extension == ".pc16") return read_pc2(std::move(file));
  throw Error("is no point cache", path.string(), "give a .pc2, .pc16 or .mdd file");
}

}  // namespace selvedge
