#include "pipeline/formats/checkpoint.hpp"
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
  const auto write = [](const std::filesystem::path& path) { write_checkpoint(path, state_of_run(), "run: {}\n"); };
  return fuzz::with_altered_file(data, size, write, [](const std::filesystem::path& path) {
    check_fits(path, read_checkpoint(path, "run: {}\n"), scene);
  });
}
