#include <dlfcn.h>

#include <catch2/catch.hpp>

#include "collision/geometry/parallel.hpp"
#include "pipeline/tools/info.hpp"

namespace selvedge::test_info {

TEST_CASE("info: says of OpenMP what the program was linked with") {
  const bool linked = dlsym(RTLD_DEFAULT, "omp_get_max_threads") != nullptr;
  CHECK(has_openmp() == linked);
  const std::string text = info_text();
  CHECK((text.find("SELVEDGE_OPENMP=OFF") == std::string::npos) == linked);
}

TEST_CASE("info: lists the program's own materials") {
  const std::string text = info_text();
  for (const char* name : {"cotton", "denim", "silk"}) CHECK(text.find(name) != std::string::npos);
}

}  // namespace selvedge::test_info
