#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>

#include "pipeline/formats/read_point_cache.hpp"
#include "tests/pipeline/files.hpp"

namespace selvedge::test_read_point_cache {

using Catch::Matchers::Contains;
using fake::Folder;

namespace {

std::string word(std::int32_t value) { return {reinterpret_cast<const char*>(&value), 4}; }

std::string real(float value) { return {reinterpret_cast<const char*>(&value), 4}; }

std::string head(int points, int frames, float first = 0, float sampling = 1) {
  return std::string("POINTCACHE2\0", 12) + word(1) + word(points) + real(first) + real(sampling) + word(frames);
}

std::string big_endian(std::string bytes) {
  for (std::size_t k = 0; k + 3 < bytes.size(); k += 4) std::reverse(bytes.begin() + k, bytes.begin() + k + 4);
  return bytes;
}

// One vertex at the origin.
std::string mdd(const std::vector<float>& times) {
  std::string bytes = word(static_cast<int>(times.size())) + word(1);
  for (const float time : times) bytes += real(time);
  for (std::size_t f = 0; f < times.size(); ++f) bytes += real(0) + real(0) + real(0);
  return big_endian(bytes);
}

std::string halves(const std::vector<std::uint16_t>& values) {
  return {reinterpret_cast<const char*>(values.data()), 2 * values.size()};
}

}  // namespace

TEST_CASE("Half floats of a .pc16 are read as IEEE 754 has them", "[read_point_cache]") {
  const Folder folder("pc16");
  const auto path = fake::write(folder, "a.pc16",
                                head(2, 2) + halves({0x3c00, 0xc000, 0x3555, 0x0001, 0x8000, 0x7bff,  //
                                                     0x0400, 0x83ff, 0x3800, 0x4248, 0xfbff, 0x0000}));
  const PointCache cache = read_point_cache(path);
  Points first(2, 3), second(2, 3);
  first << 1, -2, 1365.0 / 4096, std::ldexp(1, -24), 0, 65504;
  second << std::ldexp(1, -14), -1023 * std::ldexp(1, -24), 0.5, 3.140625, -65504, 0;
  REQUIRE(cache.frames.size() == 2);
  CHECK(cache.frames[0] == first);
  CHECK(cache.frames[1] == second);
}

TEST_CASE("When the samples of a point cache are is what its header says", "[read_point_cache]") {
  const Folder folder("cache_times");
  const auto read = [&](const std::string& name, const std::string& bytes) {
    return read_point_cache(fake::write(folder, name, bytes));
  };
  const std::string three = halves(std::vector<std::uint16_t>(9, 0));
  CHECK(read("a.pc16", head(1, 3, 10, 0.5f) + three).at == std::vector<double>{10, 10.5, 11});
  CHECK(read("a.pc16", head(1, 3, -1, 2) + three).at == std::vector<double>{-1, 1, 3});
  const PointCache even = read("a.mdd", mdd({0.5f, 0.75f, 1.0f}));
  CHECK(even.fps == Approx(4));
  CHECK(even.at == std::vector<double>{2, 3, 4});
  const PointCache uneven = read("a.mdd", mdd({0, 0.25f, 1.0f}));
  CHECK(uneven.fps == 1);
  CHECK(uneven.at == std::vector<double>{0, 0.25, 1});
}

TEST_CASE("What is wrong with a point cache is named", "[read_point_cache]") {
  const Folder folder("caches_wrong");
  const auto refused = [&](const std::string& name, const std::string& bytes, const std::string& words) {
    CHECK_THROWS_WITH(read_point_cache(fake::write(folder, name, bytes)), Contains(name) && Contains(words));
  };
  const std::string one = halves({0, 0, 0});
  refused("a.pc16", "", "POINTCACHE2");
  refused("a.pc16", "POINTCACHE2", "POINTCACHE2");
  refused("a.pc16", head(1, 1).substr(0, 20), "cut short");
  refused("a.pc16", head(1, 1) + one.substr(1), "has 37 bytes, 1 points in 1 frames take 38");
  refused("a.pc2", head(1, 1) + one, "take 44");
  refused("a.pc16", head(0, 1), "0 points");
  refused("a.pc16", head(1 << 30, 1 << 30), "take");
  refused("a.pc16", head(1, -1), "-1 frames");
  refused("a.pc16", head(1, 2) + one + halves({0, 0x7e00, 0}), "vertex 0 of frame 1");
  refused("a.pc16", head(1, 1) + halves({0x7c00, 0, 0}), "not finite");
  for (const float sampling : {0.0f, -1.0f, NAN, INFINITY})
    refused("a.pc16", head(1, 2, 0, sampling) + one + one, "sampling rate");
  for (const float first : {NAN, INFINITY, 1e9f}) refused("a.pc16", head(1, 1, first) + one, "starts at frame");
  refused("a.pc16", head(1, 2, 1e6f, 1e-20f) + one + one, "sample 1 at 1000000");
  refused("a.mdd", mdd({0, 1, 1}), "sample 2 at 1, after one at 1");
  refused("a.mdd", mdd({0, NAN}), "has the time nan");
  refused("a.mdd", "abc", "cut short");
  refused("a.mdd", std::string(8, '\xff'), "-1 frames");
  refused("a.abc", "", "no point cache");
  std::string version = head(1, 1) + one;
  version[12] = 2;
  refused("a.pc16", version, "version 2");
}

}  // namespace selvedge::test_read_point_cache
