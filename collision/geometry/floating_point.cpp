#include "collision/geometry/floating_point.hpp"

#include <cfenv>

#ifdef __FAST_MATH__
#error "-ffast-math breaks exact signs and continuous detection: build without it"
#endif

namespace selvedge {

void restore_standard_arithmetic() {
  std::fesetenv(FE_DFL_ENV);
#pragma omp parallel
  std::fesetenv(FE_DFL_ENV);
}

}  // namespace selvedge
