#include "pipeline/hdf5/trajectory_hdf5.hpp"
#include "tests/fuzz/valid_hdf5.hpp"
#include "tests/pipeline/fake_run.hpp"

using namespace selvedge;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto write = [](const std::filesystem::path& path) {
    const Scene scene = fake::scene(3);
    TrajectoryWriter writer(path, trajectory_info(scene, "run: {}\n", "conventional", 30));
    for (int i = 0; i < 4; ++i) writer.append(fake::frame(scene, i));
    writer.close();
  };
  return fuzz::with_altered_file(data, size, write, [](const std::filesystem::path& path) {
    const TrajectoryReader reader(path);
    for (int i = 0; i < std::min(reader.frame_count(), 8); ++i) reader.frame(i);
  });
}
