#include <catch2/catch.hpp>

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#ifdef __SSE2__
#include <xmmintrin.h>
#endif
#ifdef _OPENMP
#include <omp.h>
#endif

#include "collision/contact/ccd.hpp"
#include "collision/exact/orientation.hpp"
#include "collision/geometry/floating_point.hpp"

namespace selvedge::test_floating_point {

namespace {

constexpr double tiny = 0x1p-1070;  // below what flush-to-zero leaves

// A tetrahedron of subnormal size, and a vertex that falls through a face of that size.
bool is_exact() {
  const bool sign = orient3d(Vec3::Zero(), {tiny, 0, 0}, {0, tiny, 0}, {0, 0, tiny}) == 1;
  const std::array<Vec3, 4> x0{Vec3(0, 0, tiny), Vec3(-8, -8, 0) * tiny, Vec3(8, -8, 0) * tiny, Vec3(0, 8, 0) * tiny};
  std::array<Vec3, 4> through = x0, away = x0;
  through[0].z() = -tiny;
  away[0].z() = 2 * tiny;
  return sign && time_of_contact(PairKind::vertex_face, x0, through, 0).value_or(0) > 0.4 &&
         !time_of_contact(PairKind::vertex_face, x0, away, 0);
}

// One entry a thread.
std::vector<int> exact_on_threads() {
  std::vector<int> exact(1);
#ifdef _OPENMP
  exact.resize(static_cast<std::size_t>(omp_get_max_threads()));
#pragma omp parallel
  exact[static_cast<std::size_t>(omp_get_thread_num())] = is_exact();
#else
  exact[0] = is_exact();
#endif
  return exact;
}

#ifdef __SSE2__
void flush_to_zero() {
  constexpr unsigned flush = 0x8000, denormals_are_zero = 0x0040;
#pragma omp parallel
  _mm_setcsr(_mm_getcsr() | flush | denormals_are_zero);
}
#endif

}  // namespace

TEST_CASE("floating point: exact on every thread after flush-to-zero was switched on", "[floating]") {
  restore_standard_arithmetic();
  CHECK(exact_on_threads() == std::vector<int>(exact_on_threads().size(), 1));
#ifdef __SSE2__
  flush_to_zero();
  const std::vector<int> flushed = exact_on_threads();
  restore_standard_arithmetic();
  CHECK(flushed == std::vector<int>(flushed.size(), 0));
  CHECK(exact_on_threads() == std::vector<int>(flushed.size(), 1));
#else
  WARN("skipped: no SSE to switch flush-to-zero on");
#endif
}

TEST_CASE("floating point: no file is compiled with fast-math, and geometry without contraction", "[floating]") {
  std::ifstream file(std::string(SELVEDGE_BINARY_DIR) + "/compile_commands.json");
  if (!file) {
    WARN("skipped: the generator left no compile_commands.json");
    return;
  }
  int geometry = 0;
  for (const auto& entry : nlohmann::json::parse(file)) {
    const std::string command = entry["command"], source = entry["file"];
    INFO(source);
    for (const std::string fast : {"-ffast-math", "-Ofast", "-funsafe-math-optimizations", "-fassociative-math"})
      CHECK(command.find(fast) == std::string::npos);
    if (source.find("/collision/") == std::string::npos) continue;
    ++geometry;
    CHECK(command.rfind("-ffp-contract=off") != std::string::npos);
    CHECK(command.find("-ffp-contract=fast") == std::string::npos);
  }
  CHECK(geometry > 10);
}

}  // namespace selvedge::test_floating_point
