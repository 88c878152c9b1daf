#include "pipeline/tools/info.hpp"

#include <dlfcn.h>
#include <fmt/format.h>
#include <hdf5.h>

#include <Eigen/Core>
#include <cstdlib>
#include <utility>
#include <vector>

#include "collision/geometry/parallel.hpp"
#include "collision/search/obstacle.hpp"
#include "physics/linear/cholesky.hpp"
#include "pipeline/config/config.hpp"
#include "pipeline/host/numbers_json.hpp"
#include "pipeline/host/version.hpp"
#include "pipeline/obstacles/setup_paths.hpp"
#include "pipeline/scene/kinds.hpp"
#include "pipeline/scene/materials.hpp"

namespace selvedge {
namespace {

std::string hdf5_version() {
  unsigned major = 0, minor = 0, release = 0;
  H5get_libversion(&major, &minor, &release);
  return fmt::format("{}.{}.{}", major, minor, release);
}

// Found at run time, because the system's alternatives select the BLAS behind CHOLMOD.
std::string blas() {
  if (!Cholesky::available()) return "not used";
  using Config = char* (*)();
  if (void* config = dlsym(RTLD_DEFAULT, "openblas_get_config")) return reinterpret_cast<Config>(config)();
  return dlsym(RTLD_DEFAULT, "dgemm_") ? "unknown (not OpenBLAS)" : "none found";
}

// The way in which threads wait for work; see process_threads.cpp.
std::string waiting() {
  for (const char* name : {"OMP_WAIT_POLICY", "GOMP_SPINCOUNT"})
    if (const char* value = std::getenv(name)) return fmt::format("{}={}", name, value);
  return "as the OpenMP library does by itself";
}

std::vector<std::pair<std::string, std::string>> facts() {
  return {{"version", program_version()},
          {"compiler", __VERSION__},
          {"eigen", fmt::format("{}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION)},
          {"hdf5", hdf5_version()},
          {"json", fmt::format("{}.{}.{}", NLOHMANN_JSON_VERSION_MAJOR, NLOHMANN_JSON_VERSION_MINOR,
                               NLOHMANN_JSON_VERSION_PATCH)},
          {"cholmod", Cholesky::available() ? "in" : "left out (SELVEDGE_SUITESPARSE=OFF)"},
          {"blas", blas()},
          {"fcl", obstacle_available() ? "in" : "left out (SELVEDGE_FCL=OFF)"},
          {"openmp", has_openmp() ? "in" : "left out (SELVEDGE_OPENMP=OFF)"},
          {"threads", std::to_string(most_threads())},
          {"waiting", waiting()},
          {"steppers", joined(known_kinds().names())},
          {"materials", joined(material_names(config_folder()))}};
}

}  // namespace

std::string info_json() {
  Json json;
  for (const auto& [name, value] : facts()) json[name] = value;
  json["threads"] = most_threads();
  return json_text(json);
}

std::string info_text() {
  std::string text;
  for (const auto& [name, value] : facts()) text += fmt::format("{:<10}{}\n", name, value);
  return text;
}

}  // namespace selvedge
