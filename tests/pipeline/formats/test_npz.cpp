#include "pipeline/formats/npz.hpp"

#include <catch2/catch.hpp>
#include <limits>

#include "collision/geometry/error.hpp"
#include "tests/pipeline/fake_npz.hpp"
#include "tests/pipeline/files.hpp"
#include "tests/refusal.hpp"

namespace selvedge::test_npz {

namespace {

using Shape = std::vector<Eigen::Index>;

// What numpy 2 itself has written: numpy.savez_compressed(f = a 2 x 3 array of float32 in Fortran order, 0 to 5,
// s = ["maß"], o = an array with an empty dictionary).
const std::string by_numpy =
    "504b03042d000000080000002100ce2ce0d3ffffffffffffffff05001400662e6e70790100100098000000000000005600000000000000"
    "9bec17ea1b10c9c850c650ad9e925a9c5ca46ea5a06e9366a2aea3a09e965f54529498179f5f94920a120f292a4d050a17672416a402b9"
    "1a463a0ac69a3a0ab50ae4032e06307070606068b007620710878161810300504b03042d000000080000002100853a429affffffffffff"
    "ffff05001400732e6e7079010010008c000000000000004d000000000000009bec17ea1b10c9c850c650ad9e925a9c5ca46ea5a06e136a"
    "acaea3a09e965f54529498179f5f94920a12774bcc294e058a17672416a402f91a863a9a3a0ab50a1400ae5c0606864420be0fc400504b"
    "03042d0000000800000021000af4ec7affffffffffffffff050014006f2e6e7079010010001601000000000000c4000000000000009bec"
    "17ea1b10c9c850c650ad9e925a9c5ca46ea5a05ee3afaea3a09e965f54529498179f5f94920a12764bcc294e058a17672416a402f91a86"
    "3a9a3a0ab50a9400ae0696a9dd0c10d02396579a5b50a9179f9c5f94aa975b9a5392995854945839a58727be2835393fafb8a4a834b964"
    "cae4293dac6095537ad8f352204a264ff166689de2cc9834a57d4ad0140d6f466fc6d62919cc3dac29259505a9202d4cfe16533a3b20b2"
    "cc3d8c3553fcfcfcbcfe030198f0b62f9992d4193ba5764a2290a10700504b01022d032d000000080000002100ce2ce0d3560000009800"
    "0000050000000000000000000000800100000000662e6e7079504b01022d032d000000080000002100853a429a4d0000008c0000000500"
    "0000000000000000000080018d000000732e6e7079504b01022d032d0000000800000021000af4ec7ac400000016010000050000000000"
    "0000000000008001110100006f2e6e7079504b05060000000003000300990000000c0200000000";

std::string from_hex(const std::string& hex) {
  std::string bytes;
  for (std::size_t i = 0; i < hex.size(); i += 2) bytes += static_cast<char>(std::stoi(hex.substr(i, 2), nullptr, 16));
  return bytes;
}

// The complaint about an array of these bytes; empty if there is none.
std::string complaint(const std::string& npy) {
  try {
    npy_numbers(npy, {"a.npz", "x"});
  } catch (const Error& error) {
    CHECK(error.where() == "a.npz: x");
    CHECK_FALSE(error.cure().empty());
    return error.problem();
  }
  return "";
}

using fake::has;
using testing::refusal;

}  // namespace

TEST_CASE("arrays that numpy has written are read") {
  const fake::Folder folder("npz_numpy");
  const Npz npz(fake::write(folder, "a.npz", from_hex(by_numpy)));
  CHECK(npz.names() == std::vector<std::string>{"f", "s", "o"});
  CHECK(npz.has("f"));
  CHECK_FALSE(npz.has("f.npy"));
  CHECK(npz.numbers("f").shape == Shape{2, 3});
  CHECK(npz.numbers("f").values == std::vector<double>{0, 1, 2, 3, 4, 5});
  CHECK(npz.texts("s").values == std::vector<std::string>{"ma\xC3\x9F"});
  const std::string error = refusal([&] { npz.numbers("o"); });
  CHECK(has(error, "a.npz: o: is stored as pickled"));
  CHECK(has(error, "allow_pickle=True"));
  CHECK(has(refusal([&] { npz.texts("o"); }), "pickled"));
}

TEST_CASE("every type of number is read, stored and compressed, in all versions of the format") {
  const fake::Folder folder("npz_types");
  const fake::NpzEntries entries{{"f8", fake::npy<double>({3}, {0.1, -1e300, 3})},
                                 {"f4", fake::npy<float>({3}, {0.1F, -1e30F, 3}, 2)},
                                 {"i4", fake::npy<std::int32_t>({2}, {-7, 8}, 3)},
                                 {"i8", fake::npy<std::int64_t>({2}, {-7000000000, 8})},
                                 {"i2", fake::npy<std::int16_t>({2}, {-7, 8})},
                                 {"u1", fake::npy<std::uint8_t>({2}, {7, 255})},
                                 {"u4", fake::npy<std::uint32_t>({1, 2}, {4294967295U, 0})},
                                 {"u8", fake::npy<std::uint64_t>({1}, {5})},
                                 {"b1", fake::npy<bool>({2}, {true, false})},
                                 {"whole", fake::npy<double>({2}, {5, -2})},
                                 {"single", fake::npy<double>({}, {30})},
                                 {"none", fake::npy<double>({0, 3}, {})},
                                 {"bytes", fake::npy_of("'|S4'", false, "(2,)", std::string("ab\0\0male", 8))}};
  for (const bool compressed : {false, true}) {
    const Npz npz(fake::write_npz(folder.path / "a.npz", entries, compressed));
    CHECK(npz.numbers("f8").values == std::vector<double>{0.1, -1e300, 3});
    CHECK(npz.numbers("f4").values == std::vector<double>{0.1F, -1e30F, 3});
    CHECK(npz.numbers("i4").values == std::vector<double>{-7, 8});
    CHECK(npz.integers("i4").values == std::vector<std::int64_t>{-7, 8});
    CHECK(npz.integers("i8").values == std::vector<std::int64_t>{-7000000000, 8});
    CHECK(npz.integers("i2").values == std::vector<std::int64_t>{-7, 8});
    CHECK(npz.integers("u1").values == std::vector<std::int64_t>{7, 255});
    CHECK(npz.integers("u4").values == std::vector<std::int64_t>{4294967295, 0});
    CHECK(npz.integers("u4").shape == Shape{1, 2});
    CHECK(npz.integers("u8").values == std::vector<std::int64_t>{5});
    CHECK(npz.integers("b1").values == std::vector<std::int64_t>{1, 0});
    CHECK(npz.integers("whole").values == std::vector<std::int64_t>{5, -2});
    CHECK(npz.numbers("single").shape.empty());
    CHECK(npz.numbers("single").values == std::vector<double>{30});
    CHECK(npz.numbers("none").shape == Shape{0, 3});
    CHECK(npz.texts("bytes").values == std::vector<std::string>{"ab", "male"});
    CHECK_THROWS_AS(npz.integers("f8"), Error);
    CHECK_THROWS_AS(npz.texts("f8"), Error);
    CHECK_THROWS_AS(npz.numbers("bytes"), Error);
    CHECK(has(refusal([&] { npz.numbers("g8"); }), "a.npz: g8: is missing\n  cure: the file has: b1, bytes, f4"));
  }
}

TEST_CASE("floats of 16 bits are read") {
  // 1, -2, the largest, the least above 0, infinity: words by IEEE 754.
  const std::string words("\x00\x3C\x00\xC0\xFF\x7B\x01\x00\x00\x7C", 10);
  const std::string array = fake::npy_of("'<f2'", false, "(5,)", words);
  CHECK(npy_numbers(array, {"a.npz", "x"}).values ==
        std::vector<double>{1, -2, 65504, std::ldexp(1, -24), std::numeric_limits<double>::infinity()});
  const std::string whole = fake::npy_of("'<f2'", false, "(2,)", words.substr(0, 4));
  CHECK(npy_integers(whole, {"a.npz", "x"}).values == std::vector<std::int64_t>{1, -2});
  CHECK(has(refusal([&] { npy_integers(array, {"a.npz", "x"}); }), "which is no index"));
}

TEST_CASE("big-endian arrays are read") {
  const NpyPlace place{"a.npz", "x"};
  const auto numbers = [&](const std::string& type, std::string bytes) {
    return npy_numbers(fake::npy_of(type, false, "(2,)", bytes), place).values;
  };
  using namespace std::string_literals;
  CHECK(numbers("'>f8'", "\x3F\xF8\0\0\0\0\0\0\xC0\0\0\0\0\0\0\0"s) == std::vector<double>{1.5, -2});
  CHECK(numbers("'>f4'", "\x3F\xC0\0\0\xC0\0\0\0"s) == std::vector<double>{1.5, -2});
  CHECK(numbers("'>f2'", "\x3E\0\xC0\0"s) == std::vector<double>{1.5, -2});
  CHECK(numbers("'>i2'", "\x01\x02\xFF\xFE"s) == std::vector<double>{258, -2});
  const std::string wide = "\0\0\0\x01\0\0\0\x02\xFF\xFF\xFF\xFF\xFF\xFF\xFF\xFE"s;
  CHECK(npy_integers(fake::npy_of("'>i8'", false, "(2,)", wide), place).values ==
        std::vector<std::int64_t>{4294967298, -2});
  CHECK(npy_texts(fake::npy_of("'>U2'", false, "(2,)", "\0\0\0m\0\0\0\xDF\0\0\0x\0\0\0\0"s), place).values ==
        std::vector<std::string>{"m\xC3\x9F", "x"});
}

TEST_CASE("an archive whose entry has another name than its directory says is refused") {
  const fake::Folder folder("npz_names");
  const auto path = folder.path / "a.npz";
  fake::write_npz(path, {{"x", fake::npy<double>({1}, {1})}});
  CHECK(Npz(path).has("x"));
  std::string bytes = fake::whole(path);
  bytes.replace(bytes.find("x.npy"), 1, "y");  // the entry stands before the directory
  const std::string error = refusal([&] { Npz(fake::write(folder, "b.npz", bytes)); });
  CHECK(has(error, "b.npz"));
  CHECK(has(error, "contradict"));
}

TEST_CASE("Fortran order comes out as C order") {
  std::vector<double> c_order, fortran_order(24);
  for (std::size_t i = 0; i < 2; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      for (std::size_t k = 0; k < 4; ++k) {
        c_order.push_back(double(100 * i + 10 * j + k));
        fortran_order[i + 2 * j + 6 * k] = c_order.back();
      }
  const std::string raw(reinterpret_cast<const char*>(fortran_order.data()), 24 * sizeof(double));
  const NpyArray<double> array = npy_numbers(fake::npy_of("'<f8'", true, "(2, 3, 4)", raw), {"a.npz", "x"});
  CHECK(array.shape == Shape{2, 3, 4});
  CHECK(array.values == c_order);
}

TEST_CASE("headers as other writers spell them") {
  const std::string eight(8, '\0');
  CHECK(complaint(fake::npy_of("\"<f8\"", false, "(1L,)", eight)) == "");
  CHECK(complaint(fake::npy_of("'<f8'", false, "( 1 , 1 )", eight)) == "");
  CHECK(complaint(fake::npy_of("'<f8', 'more': [('a', '}')]", false, "(1,)", eight)) == "");
}

TEST_CASE("what is no array or not whole is refused with its reason") {
  const std::string eight(8, '\0');
  const std::string good = fake::npy<double>({1}, {1});
  CHECK(complaint(good) == "");
  CHECK(has(complaint(""), "does not begin"));
  CHECK(has(complaint("no array at all"), "does not begin"));
  for (std::size_t length = 0; length < good.size(); ++length) CHECK(complaint(good.substr(0, length)) != "");
  CHECK(has(complaint(good + "x"), "9 bytes of values, its shape and type say 8"));
  CHECK(has(complaint(fake::npy_of("'<f8'", false, "(1,)", eight, 4)), "version 4"));
  CHECK(has(complaint(fake::npy_of("'<f8'", false, "(-1,)", eight)), "shape"));
  CHECK(has(complaint(fake::npy_of("'<f8'", false, "(1.5,)", eight)), "shape"));
  CHECK(has(complaint(fake::npy_of("'<f8'", false, "1", eight)), "shape"));
  CHECK(has(complaint(fake::npy_of("'<f8'", false, "(99999999999999999999,)", eight)), "shape"));
  CHECK(has(complaint(fake::npy_of("'<f8'", false, "(4294967296, 4294967296)", eight)), "no memory"));
  CHECK(has(complaint(fake::npy_of("'<f8'", false, "(4611686018427387904,)", eight)), "no memory"));
  CHECK(has(complaint(fake::npy_of("'<f8'", false, "(1000000000000,)", eight)), "8 bytes of values"));
  CHECK(has(complaint(fake::npy_of("'<c8'", false, "(1,)", eight)), "type <c8"));
  CHECK(has(complaint(fake::npy_of("''", false, "(1,)", eight)), "type "));
  CHECK(has(complaint(fake::npy_of("'|O'", false, "(1,)", eight)), "pickled"));
  CHECK(has(complaint(fake::npy_of("[('a', '<f8'), ('b', '|O')]", false, "(1,)", eight)), "pickled"));
  CHECK(has(complaint(fake::npy_of("[('a', '<f8')]", false, "(1,)", eight)), "records"));
  CHECK(has(complaint(fake::npy_of("'<f8', 'x': {", false, "(1,)", eight)), "header"));
  const NpyPlace place{"a.npz", "x"};
  CHECK_THROWS_AS(npy_integers(fake::npy<std::uint64_t>({1}, {std::numeric_limits<std::uint64_t>::max()}), place),
                  Error);
  CHECK_THROWS_AS(npy_integers(fake::npy<double>({1}, {0.5}), place), Error);
  CHECK_THROWS_AS(npy_integers(fake::npy<double>({1}, {std::numeric_limits<double>::quiet_NaN()}), place), Error);
  CHECK_THROWS_AS(npy_texts(fake::npy_of("'<U99999999999999999'", false, "(1,)", eight), place), Error);
  CHECK_THROWS_AS(npy_texts(fake::npy_of("'<U0'", false, "(999999999999999999,)", ""), place), Error);
}

TEST_CASE("an archive that is damaged is refused") {
  const fake::Folder folder("npz_damaged");
  CHECK(has(refusal([&] { Npz(folder.path / "absent.npz"); }), "check the path"));
  CHECK_THROWS_AS(Npz(folder.path), Error);
  CHECK_THROWS_AS(Npz(fake::write(folder, "text.npz", "no archive")), Error);
  CHECK_THROWS_AS(Npz(fake::write(folder, "empty.npz", "")), Error);
  const std::vector<double> ramp{1, 2, 3, 4, 5, 6, 7, 8, 9, 10};
  for (const bool compressed : {false, true}) {
    const auto path = fake::write_npz(folder.path / "a.npz", {{"x", fake::npy<double>({10}, ramp)}}, compressed);
    const std::string whole = fake::whole(path);
    for (std::size_t length = 0; length < whole.size(); length += 7)
      CHECK_THROWS_AS(Npz(fake::write(folder, "b.npz", whole.substr(0, length))).numbers("x"), Error);
    // One byte changed: an error or, where nothing of the array depends on it, the same values.
    int refused = 0;
    for (std::size_t i = 0; i < whole.size(); i += 2) {
      std::string changed = whole;
      changed[i] = static_cast<char>(changed[i] ^ 0x55);
      std::vector<double> values;
      try {
        values = Npz(fake::write(folder, "b.npz", changed)).numbers("x").values;
      } catch (const Error&) {
        ++refused;
        continue;
      }
      CHECK(values == ramp);
    }
    CHECK(refused > static_cast<int>(whole.size()) / 6);
  }
}

TEST_CASE("an array that claims more than is read is refused before memory is taken") {
  const fake::Folder folder("npz_large");
  // Incompressible enough for the size that is put in place of the true one.
  std::vector<double> noise(50'000);
  std::uint64_t state = 1;
  for (double& x : noise) x = static_cast<double>((state = state * 6364136223846793005u + 1442695040888963407u) >> 11);
  const auto path = fake::write_npz(folder.path / "a.npz", {{"x", fake::npy<double>({50'000}, noise)}}, true);
  std::string bytes = fake::whole(path);
  const std::size_t entry = bytes.rfind("PK\x01\x02");
  REQUIRE(entry != std::string::npos);
  const std::uint32_t claimed = 300'000'000;
  std::memcpy(bytes.data() + entry + 24, &claimed, sizeof claimed);  // in the directory, and before the entry
  std::memcpy(bytes.data() + 22, &claimed, sizeof claimed);
  const std::string message = refusal([&] { Npz(fake::write(folder, "b.npz", bytes)).numbers("x"); });
  INFO(message);
  CHECK(has(message, "b.npz: x"));
  CHECK(has(message, "asks for 3e+08 bytes; 268435456 are the most"));
}

TEST_CASE("an array that is not asked for is never looked at") {
  const fake::Folder folder("npz_skipped");
  const Npz npz(fake::write_npz(folder.path / "a.npz", {{"broken", "no array"},
                                                        {"pickled", fake::npy_of("'|O'", false, "()", "\x80\x02")},
                                                        {"x", fake::npy<double>({1}, {4})}}));
  CHECK(npz.numbers("x").values == std::vector<double>{4});
  CHECK_THROWS_AS(npz.numbers("broken"), Error);
}

}  // namespace selvedge::test_npz
