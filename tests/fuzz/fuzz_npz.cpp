#include "pipeline/bodies/body_smpl.hpp"
#include "pipeline/formats/npz.hpp"
#include "pipeline/motions/clip_amass.hpp"
#include "tests/fuzz/fuzzed_file.hpp"

using namespace selvedge;

// The first byte chooses: an archive as it is, or one array, which a fuzzer seldom packs right.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view bytes = fuzz::text_of(data + 1, size - 1);
  const NpyPlace place{"fuzzed.npz", "array"};
  if (data[0] % 2 == 0) {
    fuzz::read_or_refuse([&] { npy_numbers(bytes, place); });
    fuzz::read_or_refuse([&] { npy_integers(bytes, place); });
    return fuzz::read_or_refuse([&] { npy_texts(bytes, place); });
  }
  const std::filesystem::path file = fuzz::file_of(".npz", bytes);
  fuzz::read_or_refuse([&] { read_smpl(file); });
  std::vector<std::string> warnings;
  fuzz::read_or_refuse([&] { read_amass(file, Vec3::Zero(), warnings); });
  return fuzz::read_or_refuse([&] {
    const Npz archive(file);
    for (const std::string& name : archive.names()) fuzz::read_or_refuse([&] { archive.numbers(name); });
  });
}
