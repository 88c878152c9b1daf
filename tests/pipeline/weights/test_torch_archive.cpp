#include "pipeline/weights/torch_archive.hpp"

#include <catch2/catch.hpp>
#include <map>
#include <numeric>
#include <string>
#include <vector>

#include "tests/pipeline/fake_checkpoint.hpp"
#include "tests/pipeline/fake_npz.hpp"
#include "tests/pipeline/files.hpp"
#include "tests/refusal.hpp"

namespace selvedge::test_torch_archive {

using fake::PickleText;

namespace {

using fake::has;
using testing::refusal;

const ZipForm stored{"archive", "give an archive", "do not compress", false, std::int64_t{256} << 20, false};

std::string content_of(const std::filesystem::path& path, const std::string& name) {
  return ZipArchive(path, stored).bytes(name, path.string() + ": " + name);
}

// Bytes of the numbers 0, 1, .., as torch stores them.
std::string counted(int count) {
  std::vector<float> numbers(count);
  std::iota(numbers.begin(), numbers.end(), 0.f);
  return {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(float)};
}

void put(std::string& file, std::size_t at, std::uint64_t value, int bytes) {
  for (int k = 0; k < bytes; ++k) file[at + k] = static_cast<char>(value >> (8 * k) & 0xFF);
}

}  // namespace

TEST_CASE("zip archive: entries come out with and without the wide records", "[torch_archive]") {
  const fake::Folder folder("stored");
  for (const bool wide : {false, true}) {
    const auto path = fake::write(folder, "a.zip", fake::stored_zip({{"x/one", "first"}, {"x/empty", ""}}, wide));
    CHECK(content_of(path, "x/one") == "first");
    CHECK(content_of(path, "x/empty") == "");
    CHECK(ZipArchive(path, stored).names() == std::vector<std::string>{"x/one", "x/empty"});
    CHECK(has(refusal([&] { content_of(path, "x/two"); }), "x/two: is missing in the archive"));
  }
  const auto npz = fake::write_npz(folder.path / "b.npz", {{"x", fake::npy<float>({2}, {1, 2})}});
  CHECK(content_of(npz, "x.npy") == fake::npy<float>({2}, {1, 2}));  // what libzip writes is read too
}

TEST_CASE("zip archive: compressed, encrypted, doubled and lying entries are refused", "[torch_archive]") {
  const fake::Folder folder("stored_refused");
  const auto packed = fake::write_npz(folder.path / "bomb.npz", {{"x", std::string(100'000'000, '\0')}}, true);
  CHECK(std::filesystem::file_size(packed) < 200'000);
  CHECK(has(refusal([&] { content_of(packed, "x.npy"); }), "is compressed by method 8"));

  const std::string whole = fake::stored_zip({{"x/one", "first"}, {"x/two", "second"}}, false);
  const std::size_t directory = whole.find("PK\1\2"), end = whole.rfind("PK\5\6");
  const auto complaint_with = [&](std::size_t at, std::uint64_t value, int bytes) {
    std::string changed = whole;
    put(changed, at, value, bytes);
    const auto path = fake::write(folder, "a.zip", changed);
    return refusal([&] { content_of(path, "x/one"); });
  };
  CHECK(complaint_with(directory, 0x02014b50, 4) == "");  // nothing changed
  struct Damage {
    std::size_t at;
    std::uint64_t value;
    int bytes;
  };
  const std::map<std::string, std::vector<Damage>> damages = {
      {"is encrypted", {{directory + 8, 1, 2}}},
      {"is compressed by method 8", {{directory + 10, 8, 2}}},
      {"cannot be read (CRC error)", {{directory + 16, 7, 4}}},
      {"claims 5 bytes of 6 packed ones", {{directory + 20, 6, 4}}},
      {"cannot be read", {{directory + 42, 0xFFFFFFF0, 4}, {directory + 42, 1, 4}}},
      {"cannot be opened as an archive",
       {{directory + 28, 0xFFFF, 2},
        {end + 10, 3, 2},
        {end + 10, 1, 2},
        {end + 12, 0xFFFFFF00, 4},
        {end + 16, 0xFFFFFF00, 4},
        {end + 20, 5, 2}}},
  };
  for (const auto& [complaint, all] : damages)
    for (const Damage& damage : all) CHECK(has(complaint_with(damage.at, damage.value, damage.bytes), complaint));
  CHECK(complaint_with(whole.find("x/one"), 'y', 1) == "");  // names are those of the directory

  // An entry that claims 200 GB, with the wide size that it needs for that.
  std::string large = whole;
  put(large, directory + 20, 0xFFFFFFFF, 4);
  put(large, directory + 24, 0xFFFFFFFF, 4);
  put(large, directory + 30, 20, 2);
  std::string wide(20, '\0');
  put(wide, 0, 1, 2), put(wide, 2, 16, 2), put(wide, 4, 200'000'000'000, 8), put(wide, 12, 200'000'000'000, 8);
  large.insert(directory + 46 + 5, wide);
  put(large, end + 20 + 12, end + 20 - directory, 4);
  const auto path = fake::write(folder, "large.zip", large);
  CHECK(has(refusal([&] { content_of(path, "x/one"); }), "claims 200000000000 bytes of 200000000000 packed ones"));
  CHECK(content_of(path, "x/two") == "second");

  const auto twice = fake::write(folder, "twice.zip", fake::stored_zip({{"a", "1"}, {"a", "2"}}));
  CHECK(has(refusal([&] { ZipArchive(twice, stored); }), "two entries of one name"));
  std::string many = fake::stored_zip({{"a", "1"}});
  put(many, many.rfind("PK\6\6") + 32, std::uint64_t{1} << 40, 8);
  const auto claims = fake::write(folder, "many.zip", many);
  CHECK(has(refusal([&] { ZipArchive(claims, stored); }), "cannot be opened as an archive"));
  for (std::size_t length = 0; length < whole.size(); ++length) {
    const auto cut = fake::write(folder, "cut.zip", whole.substr(0, length));
    CHECK(refusal([&] { ZipArchive(cut, stored); }) != "");
  }
}

TEST_CASE("torch archive: tensors are gathered by offset and stride", "[torch_archive]") {
  const fake::Folder folder("torch");
  const auto numbers = [&](std::int64_t offset, const std::vector<std::int64_t>& shape,
                           const std::vector<std::int64_t>& stride) {
    const std::string pickle = PickleText().tensor("0", 12, offset, shape, stride).finished();
    const auto path =
        fake::write(folder, "a.pth", fake::stored_zip({{"b/data.pkl", pickle}, {"b/data/0", counted(12)}}));
    TorchArchive archive(path);
    return archive.floats(std::get<TorchTensor>(archive.root()), "weight");
  };
  CHECK(numbers(0, {2, 3}, {3, 1}) == std::vector<float>{0, 1, 2, 3, 4, 5});
  CHECK(numbers(1, {3, 2}, {1, 4}) == std::vector<float>{1, 5, 2, 6, 3, 7});
  CHECK(numbers(4, {2, 2, 2}, {4, 2, 1}) == std::vector<float>{4, 5, 6, 7, 8, 9, 10, 11});
  CHECK(numbers(11, {}, {}) == std::vector<float>{11});
  CHECK(numbers(0, {0, 5}, {5, 1}).empty());
  CHECK(numbers(3, {4}, {0}) == std::vector<float>{3, 3, 3, 3});
}

TEST_CASE("torch archive: what is no checkpoint is one error that names it", "[torch_archive]") {
  const fake::Folder folder("torch_refused");
  const std::string tensor = PickleText().tensor("0", 12, 0, {12}, {1}).finished();
  const auto complaint = [&](const fake::Entries& entries) {
    const auto path = fake::write(folder, "a.pth", fake::stored_zip(entries));
    return refusal([&] {
      TorchArchive archive(path);
      archive.floats(std::get<TorchTensor>(archive.root()), "weight");
    });
  };
  CHECK(complaint({{"b/data.pkl", tensor}, {"b/data/0", counted(12)}}) == "");
  CHECK(complaint({{"b/data.pkl", tensor}, {"b/data/0", counted(12)}, {"b/byteorder", "little"}}) == "");
  CHECK(has(complaint({{"b/data.pkl", tensor}, {"b/data/0", counted(12)}, {"b/byteorder", "big"}}), "byte order"));
  CHECK(has(complaint({{"b/data.pkl", tensor}}), "data/0: is missing in the archive"));
  CHECK(has(complaint({{"b/data.pkl", tensor}, {"b/data/0", counted(11)}}), "44 bytes in its storage 0 instead of 12"));
  CHECK(has(complaint({{"b/data.pkl", tensor}, {"b/data/0", counted(13)}}), "52 bytes in its storage 0 instead of 12"));
  CHECK(has(complaint({{"b/x.pkl", tensor}}), "has 0 entries named data.pkl"));
  CHECK(has(complaint({{"b/data.pkl", tensor}, {"c/data.pkl", tensor}}), "has 2 entries named data.pkl"));
  CHECK(has(complaint({{"b/data.pkl",
                        "\x80\x02"
                        "cos\nsystem\n(X\2" +
                            std::string(3, '\0') + "ls\x85R."}}),
            "names the global os.system"));
  const std::string integers = PickleText()
                                   .global("torch._utils", "_rebuild_tensor_v2")
                                   .raw("((")
                                   .text("storage")
                                   .global("torch", "LongStorage")
                                   .text("0")
                                   .text("cpu")
                                   .integer(6)
                                   .raw("tQ")
                                   .integer(0)
                                   .integer(6)
                                   .raw("\x85")
                                   .integer(1)
                                   .raw("\x85\x89")
                                   .ordered_dict()
                                   .raw("tR")
                                   .finished();
  CHECK(has(complaint({{"b/data.pkl", integers}, {"b/data/0", counted(12)}}), "holds integers, not float32"));
  for (const std::string content : {"", "\x80\x02", "PK\5\6", "not a zip"}) {
    const auto path = fake::write(folder, "c.pth", content);
    CHECK(has(refusal([&] { TorchArchive{path}; }), "c.pth: cannot be opened as an archive"));
  }
  CHECK(has(refusal([&] { TorchArchive{folder.path / "nothing.pth"}; }), "No such file"));
}

}  // namespace selvedge::test_torch_archive
