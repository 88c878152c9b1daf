#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/compare/compare.hpp"
#include "pipeline/suites/bench.hpp"
#include "pipeline/suites/stability.hpp"
#include "pipeline/suites/stress.hpp"
#include "pipeline/suites/wardrobe.hpp"
#include "pipeline/tools/check.hpp"
#include "pipeline/tools/convert_body.hpp"
#include "pipeline/tools/dress.hpp"
#include "pipeline/tools/export.hpp"
#include "pipeline/tools/fit_report.hpp"
#include "pipeline/tools/push_mesh.hpp"
#include "pipeline/tools/sew_garment.hpp"
#include "pipeline/tools/untangle_mesh.hpp"
#include "pipeline/validate/validate.hpp"

namespace selvedge {

// The commands of the program, one function each. They print; what they return is the exit status: 0 well, 1 the
// result is not clean. Bad input throws Error, which main turns into 2. With `json` one object goes to standard output
// and people's text to standard error.

struct SceneArguments {
  std::filesystem::path scene;
  std::vector<std::string> overrides;  // key=value
  std::optional<std::string> stepper;
  std::optional<std::filesystem::path> weights;  // of the stepper `learned`
  std::optional<std::string> device;             // that computes its network
};

struct SimulateArguments {
  SceneArguments scene;
  std::optional<std::filesystem::path> out;  // otherwise out/NAME-OF-SCENE
  bool resume = false;
  bool view = true;
};

struct ViewArguments {
  std::vector<std::filesystem::path> runs;
  std::filesystem::path out = "view.html";
};

struct CcdArguments {
  std::vector<std::filesystem::path> files;
};

int simulate_command(const SimulateArguments&, bool json);
int plan_command(const SceneArguments&, bool json);
int check_command(const CheckRequest&, bool json);
int untangle_command(const UntangleRequest&, bool json);
int push_command(const PushRequest&, bool json);
int dress_command(const DressRequest&, bool json);
int pattern_command(const PatternRequest&, bool json);
int body_command(const BodyRequest&, bool json);
int ccd_command(const CcdArguments&, bool json);
int export_command(const ExportRequest&, bool json);
int fit_command(const FitRequest&, bool json);
int view_command(const ViewArguments&, bool json);
int bench_command(const BenchRequest&, bool json);
int stress_command(const StressRequest&, bool json);
int compare_command(const CompareRequest&, bool json);
int validate_command(const ValidateRequest&, bool json);
int stability_command(const StabilityRequest&, bool json);
int wardrobe_command(const WardrobeRequest&, bool json);
struct InfoArguments {
  std::string keys;  // user or expert: keys of scene files in place of facts about the program
};
int info_command(const InfoArguments&, bool json);

}  // namespace selvedge
