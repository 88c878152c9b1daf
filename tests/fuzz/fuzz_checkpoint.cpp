#include "collision/geometry/error.hpp"
#include "pipeline/hdf5/checkpoint.hpp"
#include "pipeline/run/memory_forms.hpp"
#include "tests/fuzz/valid_hdf5.hpp"
#include "tests/pipeline/fake_run.hpp"

using namespace selvedge;

namespace {

State state_of_run() {
  State state = fake::setup().initial;
  state.frame = 7;
  state.cut_out = {1, 3};
  state.memory = {{"learned.before", state.x, RowsOf::vertices, true},
                  {"resting.seconds", MemoryRows::Constant(1, 1, 0.2), RowsOf::cloths},
                  {"bdf2.length", MemoryRows::Constant(1, 1, 0.01)}};
  return state;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Scene scene = fake::scene();
  const auto write = [](const std::filesystem::path& path) {
    write_checkpoint(path, state_of_run(), {"run: {}\n", {{"c.obj", 7}}, 9});
  };
  return fuzz::with_altered_file(data, size, write, [](const std::filesystem::path& path) {
    const State state = read_checkpoint(path).state;
    check_fits(path, state, scene);
    if (const auto problem = misfit(state.memory, scene)) throw Error(*problem, path.string(), "");
  });
}
