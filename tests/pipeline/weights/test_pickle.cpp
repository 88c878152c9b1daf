#include "pipeline/weights/pickle.hpp"

#include <catch2/catch.hpp>

#include "collision/geometry/error.hpp"
#include "tests/pipeline/fake_checkpoint.hpp"

namespace selvedge::test_pickle {

using fake::PickleText;

namespace {

// What is said against a pickle; empty if it is read.
std::string pickle_complaint(const std::string& bytes) {
  try {
    read_pickle(bytes, "a.pth: data.pkl");
  } catch (const Error& error) {
    CHECK(error.where().starts_with("a.pth: data.pkl"));
    CHECK_FALSE(error.cure().empty());
    return error.problem();
  }
  return "";
}

std::string opcodes(const std::string& raw) { return PickleText().raw(raw).finished(); }

std::string four_bytes(std::uint32_t value) {
  std::string text;
  for (int k = 0; k < 4; ++k) text += static_cast<char>(value >> (8 * k) & 0xFF);
  return text;
}

template <class T>
T only_value(const std::string& raw) {
  const Pickle pickle = read_pickle(opcodes(raw), "here");
  return std::get<T>(pickle.values[pickle.root]);
}

std::string global_line(const char* a, const char* b) { return std::string("c") + a + "\n" + b + "\n"; }

// Tuples in tuples around a list: each of `levels` holds the one before `times` times.
std::string nested(int levels, int times) {
  std::string raw = std::string(levels, '(') + "]";
  for (int level = 0; level < levels; ++level) {
    raw += "q\1";
    for (int k = 1; k < times; ++k) raw += "h\1";
    raw += "t";
  }
  return raw;
}

}  // namespace

TEST_CASE("pickle: plain values come out as Python wrote them", "[pickle]") {
  CHECK(only_value<std::int64_t>("K\xff") == 255);
  CHECK(only_value<std::int64_t>("M\xff\xff") == 65535);
  CHECK(only_value<std::int64_t>("J\xfe\xff\xff\xff") == -2);
  CHECK(only_value<std::int64_t>(std::string("\x8a\0", 2)) == 0);
  CHECK(only_value<std::int64_t>("\x8a\x01\xff") == -1);
  CHECK(only_value<std::int64_t>(std::string("\x8a\x02\xff\0", 4)) == 255);
  CHECK(only_value<std::int64_t>("\x8a\x08\xff\xff\xff\xff\xff\xff\xff\x7f") == INT64_MAX);
  CHECK(only_value<double>(std::string("G\x3f\xf8\0\0\0\0\0\0", 9)) == 1.5);
  CHECK(only_value<bool>("\x88"));
  CHECK_FALSE(only_value<bool>("\x89"));
  CHECK(only_value<std::string>(std::string("X\2\0\0\0", 5) + "ab") == "ab");
  only_value<PickleNone>("N");
  CHECK(only_value<PickleTuple>("K\1K\2\x86").items.size() == 2);
  CHECK(only_value<PickleTuple>("(K\1K\2K\3K\4t").items.size() == 4);
  CHECK(only_value<PickleTuple>(")").items.empty());
  CHECK(only_value<PickleList>("](K\1K\2e").items.size() == 2);

  // {"a": [1, None], "b": {3: 2.5}} with what is remembered and recalled
  PickleText text;
  text.raw("}(").text("a").raw("]").integer(1).raw("aNa").text("b").raw("}").integer(3).number(2.5).raw("su");
  const Pickle pickle = read_pickle(text.finished(), "here");
  const PickleValue& root = pickle.values[pickle.root];
  const PickleValue* const a = find(pickle, root, "a");
  REQUIRE(a);
  CHECK(std::get<PickleList>(*a).items.size() == 2);
  CHECK(std::get<PickleDict>(*find(pickle, root, "b")).entries.size() == 1);
  CHECK(find(pickle, root, "c") == nullptr);
  CHECK(find(pickle, *a, "a") == nullptr);
}

TEST_CASE("pickle: a list that is remembered empty is recalled full", "[pickle]") {
  const Pickle pickle = read_pickle(opcodes("]q\1K\7ah\1\x86"), "here");  // list in a tuple twice
  const auto& tuple = std::get<PickleTuple>(pickle.values[pickle.root]);
  REQUIRE(tuple.items.size() == 2);
  CHECK(tuple.items[0] == tuple.items[1]);
  CHECK(std::get<PickleList>(pickle.values[tuple.items[0]]).items.size() == 1);
}

TEST_CASE("pickle: tensors are views that lie inside their storage", "[pickle]") {
  const auto tensor = [](std::int64_t count, std::int64_t offset, const std::vector<std::int64_t>& shape,
                         const std::vector<std::int64_t>& stride) {
    return PickleText().tensor("7", count, offset, shape, stride).finished();
  };
  const Pickle pickle = read_pickle(tensor(20, 2, {3, 4}, {5, 1}), "here");
  const auto& read = std::get<TorchTensor>(pickle.values[pickle.root]);
  CHECK(read.storage.key == "7");
  CHECK(read.elements == 12);
  CHECK(read.shape == std::vector<std::int64_t>{3, 4});
  CHECK(pickle_complaint(tensor(16, 2, {3, 4}, {5, 1})) == "");
  CHECK(pickle_complaint(tensor(15, 2, {3, 4}, {5, 1})) ==
        "has a tensor of shape [3, 4] that does not lie inside its storage of 15 numbers");
  CHECK(pickle_complaint(tensor(1, 0, {}, {})) == "");
  CHECK(pickle_complaint(tensor(0, 0, {}, {})) != "");
  CHECK(pickle_complaint(tensor(0, 0, {0, 7}, {7, 1})) == "");
  CHECK(pickle_complaint(tensor(4, 5, {0}, {1})) != "");
  CHECK(pickle_complaint(tensor(4, -1, {2}, {1})) != "");
  CHECK(pickle_complaint(tensor(4, 0, {5}, {0})) != "");  // more elements than numbers: one number made many
  CHECK(pickle_complaint(tensor(4, 0, {2, 2}, {1})).find("2 sizes and 1 strides") != std::string::npos);
  CHECK(pickle_complaint(tensor(4, 0, {-1}, {1})) == "has a tensor with a size of -1");
  CHECK(pickle_complaint(tensor(4, 0, {1, 1, 1, 1, 1, 1, 1, 1, 1}, {1, 1, 1, 1, 1, 1, 1, 1, 1})) != "");
  constexpr std::int64_t huge = 0x7FFFFFFF;
  CHECK(pickle_complaint(tensor(huge, huge, {huge, huge, huge, huge}, {huge, huge, huge, huge})) != "");
  CHECK(pickle_complaint(tensor(huge, 0, {65536, 65536, 65536, 65536}, {0, 0, 0, 0})) != "");
}

TEST_CASE("pickle: a foreign global is refused by its name, and so is a known one in the wrong place", "[pickle]") {
  const std::vector<std::pair<const char*, const char*>> foreign = {{"os", "system"},
                                                                    {"posix", "system"},
                                                                    {"builtins", "eval"},
                                                                    {"builtins", "exec"},
                                                                    {"builtins", "getattr"},
                                                                    {"subprocess", "Popen"},
                                                                    {"torch", "load"},
                                                                    {"torch", "DoubleStorage"},
                                                                    {"torch._utils", "_rebuild_parameter"},
                                                                    {"collections", "defaultdict"},
                                                                    {"__builtin__", "set"},
                                                                    {"collections", "OrderedDict.__init__"},
                                                                    {"torch.FloatStorage", ""},
                                                                    {"", "torch.FloatStorage"}};
  for (const auto& [module, name] : foreign) {
    const std::string global = std::string(module) + "." + name;
    INFO(global);
    CHECK(pickle_complaint(opcodes(global_line(module, name) + "(X\2\0\0\0lst"
                                                               "tR")) ==
          "names the global " + global + ", which weights do not need");
  }
  CHECK(pickle_complaint(opcodes(global_line("os\x1b[2J", "a\x07"))).find("os?[2J.a?") != std::string::npos);
  const std::string dict = global_line("collections", "OrderedDict"), storage = global_line("torch", "FloatStorage"),
                    rebuild = global_line("torch._utils", "_rebuild_tensor_v2");
  CHECK(pickle_complaint(opcodes(dict)) == "holds a global as a value");
  CHECK(pickle_complaint(opcodes("](" + storage + "e")) == "holds a global as a value");
  CHECK(pickle_complaint(PickleText().storage("1", 3).finished()) == "holds a storage without a tensor");
  CHECK(pickle_complaint(opcodes(dict + "K\1\x85R")) == "makes an OrderedDict with arguments");
  CHECK(pickle_complaint(opcodes(storage + ")R")) == "calls a storage type");
  CHECK(pickle_complaint(opcodes(rebuild + ")R")) == "makes a tensor of 0 arguments");
  CHECK(pickle_complaint(opcodes(rebuild + "(K\1K\1))\x89}tR")) == "makes a tensor of arguments of the wrong types");
  CHECK(pickle_complaint(opcodes("K\1)R")) == "calls what cannot be called");
  CHECK(pickle_complaint(opcodes(dict + "NR")) == "calls what cannot be called");
  CHECK(pickle_complaint(opcodes("K\1Q")) == "has a persistent id that is no tuple");
  CHECK(pickle_complaint(opcodes(")Q")) == "has a persistent id of 0 parts");
  CHECK(pickle_complaint(PickleText().storage("../../etc/passwd", 3).finished()) ==
        "has a storage under the key ../../etc/passwd");
  CHECK(pickle_complaint(PickleText().storage("1", -5).finished()) == "has a storage of -5 numbers");
  CHECK(pickle_complaint(PickleText().raw("}}").text("__class__").raw("Nsb").finished()) ==
        "sets an attribute other than _metadata");
  CHECK(pickle_complaint(opcodes("}Nb")) == "sets the state of a dictionary to what is no dictionary");
  CHECK(pickle_complaint(opcodes("]}b")) == "puts something into what is no dictionary");
}

TEST_CASE("pickle: an opcode outside of the list is refused", "[pickle]") {
  const std::string known = "(.GJKMNQRX]abcehjqrst)u}\x85\x86\x87\x88\x89\x8a";
  for (int code = 0; code < 256; ++code) {
    const std::string complaint = pickle_complaint(opcodes(std::string(1, static_cast<char>(code))));
    INFO(code << ": " << complaint);
    const bool is_known = known.find(static_cast<char>(code)) != std::string::npos;
    CHECK(complaint.starts_with("has the opcode ") != is_known);
  }
  CHECK(pickle_complaint(opcodes("\x93")) == "has the opcode STACK_GLOBAL, which weights do not need");
  CHECK(pickle_complaint(opcodes("i")) == "has the opcode INST, which weights do not need");
  CHECK(pickle_complaint(opcodes("\x81")) == "has the opcode NEWOBJ, which weights do not need");
  CHECK(pickle_complaint(opcodes("\x07")) == "has the opcode 0x07, which weights do not need");
  CHECK(pickle_complaint("\x80\x04N.") == "is no pickle of protocol 2");
  CHECK(pickle_complaint("N.") == "is no pickle of protocol 2");
}

TEST_CASE("pickle: what is cut short, out of order or too much is an error", "[pickle]") {
  PickleText text;
  text.raw("}(").text("a").tensor("0", 6, 0, {2, 3}, {3, 1}).text("b").number(1).raw("u");
  const std::string whole = text.finished();
  CHECK(pickle_complaint(whole) == "");
  for (std::size_t end = 0; end < whole.size(); ++end) CHECK(pickle_complaint(whole.substr(0, end)) != "");
  CHECK(pickle_complaint(whole + "N") == "goes on for 1 bytes after its end");
  for (const std::string raw :
       {"",     "NN",      "(N",  "a",   "u",   "t",      "e",       "R",      "Q",    "b",    "s",
        "\x85", "K\1\x86", "q\1", "h\1", "N(a", "](\x85", "K\1K\1a", "}(K\1u", "}NNs", "})Ns", "K\1(e"}) {
    INFO(raw);
    CHECK(pickle_complaint(opcodes(raw)) != "");
  }
  CHECK(pickle_complaint(opcodes("}(K\1NK\1Nu")) == "has the key 1 twice in one dictionary");
  CHECK(pickle_complaint(PickleText().raw("}(").text("k").raw("N").text("k").raw("Nu").finished()) ==
        "has the key k twice in one dictionary");
  CHECK(pickle_complaint(opcodes("X\xff\xff\xff\xff")) == "is cut short: 4294967295 bytes are announced, 1 are left");
  CHECK(pickle_complaint(opcodes("\x8a\x09"
                                 "123456789")) == "has an integer of 9 bytes; 8 are the most");
  CHECK(pickle_complaint(opcodes("Nr" + four_bytes(0xFFFFFFFF))).starts_with("remembers a value under the number"));
  CHECK(pickle_complaint(opcodes("Nj" + four_bytes(0xFFFFFFFF))).starts_with("recalls value 4294967295"));
  CHECK(pickle_complaint(opcodes(std::string(1'000'001, 'N'))) == "has more than 1000000 values");
  CHECK(pickle_complaint(opcodes(std::string(std::size_t{17} << 20, '('))).starts_with("has 17825795 bytes"));
}

TEST_CASE("pickle: bombs of nested and shared values are refused", "[pickle]") {
  CHECK(pickle_complaint(opcodes(nested(99, 1))) == "");
  CHECK(pickle_complaint(opcodes(nested(100, 1))) == "nests deeper than 100");
  CHECK(pickle_complaint(opcodes(nested(400'000, 1))) == "nests deeper than 100");
  CHECK(pickle_complaint(opcodes(std::string(500'000, ']') + std::string(499'999, 'a'))) == "nests deeper than 100");
  CHECK(pickle_complaint(opcodes(nested(20, 2))) == "");
  CHECK(pickle_complaint(opcodes(nested(60, 2))) == "unfolds to more than 20000000 values");
  CHECK(pickle_complaint(opcodes(nested(90, 100))) == "unfolds to more than 20000000 values");
  CHECK(pickle_complaint(opcodes("]q\1h\1a")) == "has a value that contains itself");
  CHECK(pickle_complaint(opcodes("}q\1K\1]h\1as")) == "has a value that contains itself");
}

}  // namespace selvedge::test_pickle
