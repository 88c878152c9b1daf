#include "pipeline/weights/pickle.hpp"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <limits>

#include "collision/geometry/error.hpp"
#include "pipeline/weights/pickle_check.hpp"
#include "pipeline/weights/torch_tensor.hpp"

namespace selvedge {
namespace {

constexpr std::size_t most_values = 1'000'000, most_bytes = std::size_t{16} << 20, most_memo = std::size_t{1} << 22;

enum Opcode : unsigned char {
  mark = '(',
  stop = '.',
  binfloat = 'G',
  binint = 'J',
  binint1 = 'K',
  binint2 = 'M',
  none = 'N',
  binpersid = 'Q',
  reduce = 'R',
  binunicode = 'X',
  empty_list = ']',
  append = 'a',
  build = 'b',
  global = 'c',
  appends = 'e',
  binget = 'h',
  long_binget = 'j',
  binput = 'q',
  long_binput = 'r',
  setitem = 's',
  tuple = 't',
  empty_tuple = ')',
  setitems = 'u',
  empty_dict = '}',
  proto = 0x80,
  tuple1 = 0x85,
  tuple2 = 0x86,
  tuple3 = 0x87,
  newtrue = 0x88,
  newfalse = 0x89,
  long1 = 0x8a
};

// Names of opcodes that this reader refuses, for messages.
std::string refused_name(unsigned char code) {
  constexpr std::array<std::pair<unsigned char, const char*>, 34> names{{
      {'0', "POP"},
      {'1', "POP_MARK"},
      {'2', "DUP"},
      {'F', "FLOAT"},
      {'I', "INT"},
      {'L', "LONG"},
      {'P', "PERSID"},
      {'S', "STRING"},
      {'T', "BINSTRING"},
      {'U', "SHORT_BINSTRING"},
      {'V', "UNICODE"},
      {'B', "BINBYTES"},
      {'C', "SHORT_BINBYTES"},
      {'d', "DICT"},
      {'g', "GET"},
      {'i', "INST"},
      {'l', "LIST"},
      {'o', "OBJ"},
      {'p', "PUT"},
      {0x81, "NEWOBJ"},
      {0x82, "EXT1"},
      {0x83, "EXT2"},
      {0x84, "EXT4"},
      {0x8b, "LONG4"},
      {0x8c, "SHORT_BINUNICODE"},
      {0x8d, "BINUNICODE8"},
      {0x8e, "BINBYTES8"},
      {0x8f, "EMPTY_SET"},
      {0x90, "ADDITEMS"},
      {0x91, "FROZENSET"},
      {0x92, "NEWOBJ_EX"},
      {0x93, "STACK_GLOBAL"},
      {0x94, "MEMOIZE"},
      {0x95, "FRAME"},
  }};
  for (const auto& [known, name] : names)
    if (known == code) return name;
  return fmt::format("0x{:02x}", code);
}

// A stack machine that builds plain values, with one function for an opcode or a family of them.
class PickleReader {
 public:
  PickleReader(std::string_view bytes, const std::string& where) : bytes_(bytes), where_(where) {}

  Pickle read() {
    if (bytes_.size() > most_bytes) fail(fmt::format("has {} bytes, more than {}", bytes_.size(), most_bytes));
    if (next() != proto || next() != 2) fail("is no pickle of protocol 2");
    unsigned char code = 0;
    while ((code = next()) != stop) step(code);
    if (stack_.size() != 1 || !marks_.empty())
      fail(fmt::format("ends with {} values and {} marks instead of one value", stack_.size(), marks_.size()));
    if (at_ != bytes_.size()) fail(fmt::format("goes on for {} bytes after its end", bytes_.size() - at_));
    pickle_.root = stack_.back();
    return std::move(pickle_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    refuse_pickle(what, fmt::format("{}, byte {}", where_, at_));
  }

  std::string_view take(std::size_t count) {
    if (count > bytes_.size() - at_)
      fail(fmt::format("is cut short: {} bytes are announced, {} are left", count, bytes_.size() - at_));
    at_ += count;
    return bytes_.substr(at_ - count, count);
  }
  unsigned char next() { return static_cast<unsigned char>(take(1)[0]); }

  std::uint64_t little_endian(std::size_t count) {
    const std::string_view bytes = take(count);
    std::uint64_t value = 0;
    for (std::size_t k = count; k-- > 0;) value = value << 8 | static_cast<unsigned char>(bytes[k]);
    return value;
  }

  double big_endian_double() {
    std::uint64_t bits = 0;
    for (const char byte : take(8)) bits = bits << 8 | static_cast<unsigned char>(byte);
    return std::bit_cast<double>(bits);
  }

  std::int64_t long_integer() {
    const std::size_t count = next();
    if (count > 8) fail(fmt::format("has an integer of {} bytes; 8 are the most", count));
    std::uint64_t value = little_endian(count);
    if (count > 0 && count < 8 && (value >> (8 * count - 1)) != 0) value |= ~std::uint64_t{0} << (8 * count);
    return std::bit_cast<std::int64_t>(value);
  }

  std::string_view line() {
    const std::size_t end = bytes_.find('\n', at_);
    if (end == std::string_view::npos) fail("is cut short in the name of a global");
    const std::string_view text = take(end - at_);
    ++at_;
    return text;
  }

  // Removes the newest `count` values above the last mark from the stack.
  std::vector<PickleIndex> pop(std::size_t count) {
    const std::size_t floor = marks_.empty() ? 0 : marks_.back();
    if (stack_.size() - floor < count) fail("takes a value from an empty stack");
    const auto from = stack_.end() - static_cast<std::ptrdiff_t>(count);
    std::vector<PickleIndex> taken(from, stack_.end());
    stack_.erase(from, stack_.end());
    return taken;
  }
  PickleIndex pop() { return pop(1).front(); }

  std::vector<PickleIndex> pop_to_mark() {
    if (marks_.empty()) fail("goes back to a mark that is not there");
    std::vector<PickleIndex> taken = pop(stack_.size() - marks_.back());
    marks_.pop_back();
    return taken;
  }

  PickleIndex top() {
    if (stack_.size() == (marks_.empty() ? 0 : marks_.back())) fail("takes a value from an empty stack");
    return stack_.back();
  }

  void push(PickleValue value) {
    if (pickle_.values.size() == most_values) fail(fmt::format("has more than {} values", most_values));
    pickle_.values.push_back(std::move(value));
    stack_.push_back(static_cast<PickleIndex>(pickle_.values.size() - 1));
  }

  template <class T>
  T& topmost(const char* expected) {
    T* const value = std::get_if<T>(&pickle_.values[top()]);
    if (!value) fail(fmt::format("puts something into what is no {}", expected));
    return *value;
  }

  void remember(std::size_t slot) {
    if (slot >= most_memo) fail(fmt::format("remembers a value under the number {}; {} are the most", slot, most_memo));
    if (slot >= memo_.size()) memo_.resize(slot + 1, forgotten);
    memo_[slot] = top();
  }
  void recall(std::size_t slot) {
    if (slot >= memo_.size() || memo_[slot] == forgotten)
      fail(fmt::format("recalls value {}, which it never remembered", slot));
    stack_.push_back(memo_[slot]);
  }

  void read_global() {
    const std::string_view module = line(), name = line();
    const std::string full = std::string(module) + "." + std::string(name);
    if (full == "collections.OrderedDict") return push(PickleGlobal::ordered_dict);
    if (full == "torch.FloatStorage") return push(PickleGlobal::float_storage);
    if (full == "torch.LongStorage") return push(PickleGlobal::long_storage);
    if (full == "torch._utils._rebuild_tensor_v2") return push(PickleGlobal::rebuild_tensor);
    fail("names the global " + shown(full) + ", which weights do not need");
  }

  void add_items(const std::vector<PickleIndex>& items) {
    auto& list = topmost<PickleList>("list").items;
    list.insert(list.end(), items.begin(), items.end());
  }

  void add_entries(const std::vector<PickleIndex>& flat) {
    if (flat.size() % 2 != 0) fail("gives a dictionary a key without a value");
    auto& entries = topmost<PickleDict>("dictionary").entries;
    for (std::size_t k = 0; k < flat.size(); k += 2) {
      const PickleValue& key = pickle_.values[flat[k]];
      if (!std::holds_alternative<std::string>(key) && !std::holds_alternative<std::int64_t>(key))
        fail("gives a dictionary a key that is neither text nor an integer");
      entries.emplace_back(flat[k], flat[k + 1]);
    }
  }

  // torch adds `_metadata`, the versions of modules, to the dictionary of weights. Nothing reads it here.
  void read_build() {
    const PickleValue& state = pickle_.values[pop()];
    topmost<PickleDict>("dictionary");
    const auto* attributes = std::get_if<PickleDict>(&state);
    if (!attributes) fail("sets the state of a dictionary to what is no dictionary");
    for (const auto& [key, value] : attributes->entries) {
      const auto* name = std::get_if<std::string>(&pickle_.values[key]);
      if (!name || *name != "_metadata") fail("sets an attribute other than _metadata");
    }
  }

  void read_reduce() {
    const PickleValue& arguments = pickle_.values[pop()];
    const auto* callable = std::get_if<PickleGlobal>(&pickle_.values[pop()]);
    const auto* list = std::get_if<PickleTuple>(&arguments);
    if (!callable || !list) fail("calls what cannot be called");
    if (*callable == PickleGlobal::ordered_dict) {
      if (!list->items.empty()) fail("makes an OrderedDict with arguments");
      return push(PickleDict{});
    }
    if (*callable != PickleGlobal::rebuild_tensor) fail("calls a storage type");
    push(torch_tensor(pickle_, *list, fmt::format("{}, byte {}", where_, at_)));
  }

  void read_storage() {
    const auto* list = std::get_if<PickleTuple>(&pickle_.values[pop()]);
    if (!list) fail("has a persistent id that is no tuple");
    push(torch_storage(pickle_, *list, fmt::format("{}, byte {}", where_, at_)));
  }

  void step(unsigned char code) {
    switch (code) {
      case mark:
        return marks_.push_back(stack_.size());
      case none:
        return push(PickleNone{});
      case newtrue:
        return push(true);
      case newfalse:
        return push(false);
      case binint:
        return push(std::int64_t{static_cast<std::int32_t>(little_endian(4))});
      case binint1:
        return push(static_cast<std::int64_t>(little_endian(1)));
      case binint2:
        return push(static_cast<std::int64_t>(little_endian(2)));
      case long1:
        return push(long_integer());
      case binfloat:
        return push(big_endian_double());
      case binunicode:
        return push(std::string(take(little_endian(4))));
      case empty_list:
        return push(PickleList{});
      case empty_tuple:
        return push(PickleTuple{});
      case empty_dict:
        return push(PickleDict{});
      case tuple:
        return push(PickleTuple{pop_to_mark()});
      case tuple1:
        return push(PickleTuple{pop(1)});
      case tuple2:
        return push(PickleTuple{pop(2)});
      case tuple3:
        return push(PickleTuple{pop(3)});
      case append:
        return add_items(pop(1));
      case appends:
        return add_items(pop_to_mark());
      case setitem:
        return add_entries(pop(2));
      case setitems:
        return add_entries(pop_to_mark());
      case binput:
        return remember(little_endian(1));
      case long_binput:
        return remember(little_endian(4));
      case binget:
        return recall(little_endian(1));
      case long_binget:
        return recall(little_endian(4));
      case global:
        return read_global();
      case binpersid:
        return read_storage();
      case reduce:
        return read_reduce();
      case build:
        return read_build();
      default:
        fail("has the opcode " + refused_name(code) + ", which weights do not need");
    }
  }

  static constexpr PickleIndex forgotten = std::numeric_limits<PickleIndex>::max();
  std::string_view bytes_;
  const std::string& where_;
  std::size_t at_ = 0;
  Pickle pickle_;
  std::vector<PickleIndex> stack_, memo_;
  std::vector<std::size_t> marks_;
};

}  // namespace

Pickle read_pickle(std::string_view bytes, const std::string& where) {
  Pickle pickle = PickleReader(bytes, where).read();
  check_pickle(pickle, where);
  return pickle;
}

const PickleValue* find(const Pickle& pickle, const PickleValue& value, std::string_view key) {
  const auto* dict = std::get_if<PickleDict>(&value);
  if (!dict) return nullptr;
  for (const auto& [name, entry] : dict->entries)
    if (const auto* text = std::get_if<std::string>(&pickle.values[name]); text && *text == key)
      return &pickle.values[entry];
  return nullptr;
}

}  // namespace selvedge
