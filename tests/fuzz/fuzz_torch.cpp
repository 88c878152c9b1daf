#include "pipeline/weights/import_weights.hpp"
#include "pipeline/weights/torch_archive.hpp"
#include "tests/fuzz/fuzzed_file.hpp"
#include "tests/pipeline/fake_checkpoint.hpp"

using namespace selvedge;

namespace {

void read_all(const std::filesystem::path& path) {
  fuzz::read_or_refuse([&] { read_published_weights(path); });
  fuzz::read_or_refuse([&] {
    TorchArchive archive(path);
    for (const PickleValue& value : archive.pickle().values)
      if (const auto* const tensor = std::get_if<TorchTensor>(&value))
        fuzz::read_or_refuse([&] { archive.floats(*tensor, "tensor"); });
  });
}

}  // namespace

// The first byte chooses: an archive as it is, or the pickle of one that is whole, which a fuzzer cannot make: it knows
// no checksums.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string bytes(fuzz::text_of(data + 1, size - 1));
  if (data[0] % 2 == 0) {
    read_all(fuzz::file_of(".pth", bytes));
    return 0;
  }
  const fake::Entries entries = {{"a/data.pkl", bytes}, {"a/data/0", std::string(24, '\1')}, {"a/version", "3\n"}};
  read_all(fuzz::file_of(".pth", fake::stored_zip(entries)));
  return 0;
}
