#include <catch2/catch.hpp>
#include <cstring>

#include "pipeline/formats/read_point_cache.hpp"
#include "tests/pipeline/files.hpp"

namespace selvedge::test_read_point_cache {

using Catch::Matchers::Contains;
using fake::Folder;

namespace {

std::string word(std::int32_t value) { return {reinterpret_cast<const char*>(&value), 4}; }

std::string head(int points, int frames) {
  return std::string("POINTCACHE2\0", 12) + word(1) + word(points) + word(0) + word(0x3f800000) + word(frames);
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
  refused("a.mdd", "abc", "cut short");
  refused("a.mdd", std::string(8, '\xff'), "-1 frames");
  refused("a.abc", "", "no point cache");
  std::string version = head(1, 1) + one;
  version[12] = 2;
  refused("a.pc16", version, "version 2");
}

}  // namespace selvedge::test_read_point_cache
