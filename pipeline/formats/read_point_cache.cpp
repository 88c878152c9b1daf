#include "pipeline/formats/read_point_cache.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>

#include "collision/geometry/error.hpp"
#include "pipeline/host/read_file.hpp"

namespace selvedge {
namespace {

static_assert(std::endian::native == std::endian::little, "MDD is read by turning its bytes round");

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

  double coordinate() {
    if (!half) return next<float>();
    const auto word = next<std::uint16_t>();  // IEEE 754 binary16
    const int exponent = word >> 10 & 31, digits = word & 1023;
    const double size = exponent == 31 ? (digits ? NAN : INFINITY)
                                       : std::ldexp(exponent ? 1024 + digits : digits, (exponent ? exponent : 1) - 25);
    return word >> 15 ? -size : size;
  }

  void check_size(std::int32_t points, std::int32_t frames, std::size_t head) const {
    if (points < 1 || frames < 1)
      fail(fmt::format("has {} points and {} frames", points, frames), "write one of each at least");
    const double whole = static_cast<double>(head) + (half ? 2.0 : 4.0) * 3 * points * frames;
    if (whole != static_cast<double>(bytes.size()))
      fail(fmt::format("has {} bytes, {} points in {} frames take {:.0f}", bytes.size(), points, frames, whole),
           half ? "write it anew, as half floats: it is cut short, or has others"
                : "write it anew, as 32-bit floats: it is cut short, or has others");
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

PointCache read_pc2(CacheBytes file) {
  const std::string head("POINTCACHE2\0", 12);
  if (!file.bytes.starts_with(head)) file.fail("does not begin with POINTCACHE2", "give a .pc2 or .pc16 file");
  file.at = head.size();
  if (const auto version = file.next<std::int32_t>(); version != 1)
    file.fail(fmt::format("has version {}", version), "write version 1, which alone is read");
  const auto points = file.next<std::int32_t>();
  file.next<float>();  // first frame
  file.next<float>();  // frames a sample
  const auto frames = file.next<std::int32_t>();
  file.check_size(points, frames, file.at);
  return {0, file.read(points, frames)};
}

PointCache read_mdd(CacheBytes file) {
  const auto frames = file.next<std::int32_t>(), points = file.next<std::int32_t>();
  file.check_size(points, frames, 8 + 4 * static_cast<std::size_t>(std::max(frames, 0)));
  std::vector<double> times;
  for (std::int32_t f = 0; f < frames; ++f) times.push_back(file.next<float>());
  PointCache cache;
  if (frames > 1) {
    const double step = (times.back() - times.front()) / (frames - 1);
    for (std::int32_t f = 0; f < frames; ++f)
      if (!(step > 0) || !(std::abs(times[static_cast<std::size_t>(f)] - times.front() - f * step) <= 0.01 * step))
        file.fail(fmt::format("has uneven times, at frame {}", f), "write it at a steady rate");
    cache.fps = 1 / step;
  }
  cache.frames = file.read(points, frames);
  return cache;
}

}  // namespace

PointCache read_point_cache(const std::filesystem::path& path) {
  const std::string extension = path.extension().string();
  CacheBytes file{path.string(), read_file(path, "point cache"), extension == ".mdd", extension == ".pc16"};
  if (extension == ".mdd") return read_mdd(std::move(file));
  if (extension == ".pc2" || extension == ".pc16") return read_pc2(std::move(file));
  throw Error("is no point cache", path.string(), "give a .pc2, .pc16 or .mdd file");
}

}  // namespace selvedge
