#include "pipeline/formats/npy.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <type_traits>

#include <fmt/format.h>

#include "collision/geometry/error.hpp"
#include "pipeline/formats/half_float.hpp"

namespace selvedge {
namespace {

struct Header {
  std::string type;  // numpy's descr, such as "<f8"
  bool big_endian = false;
  bool fortran_order = false;
  std::vector<std::size_t> shape;
  std::size_t count = 1;  // of values
  std::size_t begin = 0;  // byte offset of the values
};

// A float of 16 bits, as it is stored.
struct Half {
  std::uint16_t word = 0;
};

constexpr std::string_view magic = "\x93NUMPY";

[[noreturn]] void fail_broken(const std::string& what, const NpyPlace& place) {
  throw Error(what, place.text(), "the file is damaged or no array of numpy; copy it again, or save it anew");
}

// Refuses pickled objects: unpickling would run any program that the file contains.
[[noreturn]] void fail_pickled(const NpyPlace& place) {
  const std::string script = fmt::format(
      "import numpy as np; d = dict(np.load('{0}', allow_pickle=True)); a = d['{1}'].tolist(); "
      "d['{1}'] = np.array(a.toarray() if hasattr(a, 'toarray') else a, float); np.savez('plain.npz', **d)",
      place.file, place.field);
  throw Error("is stored as pickled Python objects, which are not read", place.text(),
              "if you trust the file, convert it to plain arrays: python3 -c \"" + script + "\"");
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view space = " \t\r\n";
  const std::size_t begin = text.find_first_not_of(space);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(space) - begin + 1);
}

// Cuts a Python literal at the commas, or at the first colon, that no bracket or quote encloses.
std::vector<std::string_view> split(std::string_view text, char at, bool once) {
  std::vector<std::string_view> parts;
  std::size_t begin = 0;
  int depth = 0;
  char quote = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quote) {
      if (c == quote) quote = 0;
    } else if (c == '\'' || c == '"') {
      quote = c;
    } else if (c == '(' || c == '[' || c == '{') {
      ++depth;
    } else if (c == ')' || c == ']' || c == '}') {
      --depth;
    } else if (c == at && depth == 0 && !(once && !parts.empty())) {
      parts.push_back(trimmed(text.substr(begin, i - begin)));
      begin = i + 1;
    }
  }
  parts.push_back(trimmed(text.substr(begin)));
  return parts;
}

bool enclosed(std::string_view text, char open, char close) {
  return text.size() >= 2 && text.front() == open && text.back() == close;
}

bool is_quoted(std::string_view text) { return enclosed(text, '\'', '\'') || enclosed(text, '"', '"'); }

std::string_view inner(std::string_view text) { return text.substr(1, text.size() - 2); }

std::vector<std::size_t> read_shape(std::string_view text, const NpyPlace& place) {
  if (!enclosed(text, '(', ')')) fail_broken(fmt::format("has a header with the shape `{}`", text), place);
  std::vector<std::size_t> shape;
  for (std::string_view part : split(inner(text), ',', false)) {
    if (part.empty()) continue;
    const std::string_view digits = part.back() == 'L' ? part.substr(0, part.size() - 1) : part;  // as Python 2 wrote
    std::size_t extent = 0;
    const auto [end, problem] = std::from_chars(digits.data(), digits.data() + digits.size(), extent);
    if (problem != std::errc() || end != digits.data() + digits.size())
      fail_broken(fmt::format("has a header with the shape `{}`", text), place);
    shape.push_back(extent);
  }
  return shape;
}

void read_dictionary(std::string_view text, const NpyPlace& place, Header& header) {
  text = trimmed(text);
  if (!enclosed(text, '{', '}')) fail_broken("has a header that is no dictionary", place);
  std::map<std::string_view, std::string_view> entries;
  for (std::string_view item : split(inner(text), ',', false)) {
    const std::vector<std::string_view> pair = split(item, ':', true);
    if (pair.size() == 2 && is_quoted(pair[0])) entries[inner(pair[0])] = pair[1];
  }
  for (const std::string_view key : {"descr", "fortran_order", "shape"})
    if (!entries.contains(key)) fail_broken(fmt::format("has a header without `{}`", key), place);
  const std::string_view type = entries["descr"], order = entries["fortran_order"];
  if (!is_quoted(type) && type.find("|O") != std::string_view::npos) fail_pickled(place);
  if (!is_quoted(type))
    throw Error("is an array of records", place.text(), "save each of their fields as an array of its own");
  header.type = inner(type);
  if (order != "True" && order != "False")
    fail_broken(fmt::format("has a header with fortran_order `{}`", order), place);
  header.fortran_order = order == "True";
  header.shape = read_shape(entries["shape"], place);
}

std::size_t little_endian(std::string_view bytes) {
  std::size_t value = 0;
  for (std::size_t k = bytes.size(); k-- > 0;) value = 256 * value + static_cast<unsigned char>(bytes[k]);
  return value;
}

Header read_header(std::string_view bytes, const NpyPlace& place) {
  if (!bytes.starts_with(magic) || bytes.size() < 12) fail_broken("does not begin as an array of numpy", place);
  const int version = bytes[6];
  if (version < 1 || version > 3)
    throw Error(fmt::format("has format version {}, known are 1 to 3", version), place.text(),
                "save it with numpy.savez of a plain array");
  const std::size_t length_bytes = version == 1 ? 2 : 4, length = little_endian(bytes.substr(8, length_bytes));
  Header header;
  if (length > bytes.size() - 8 - length_bytes) fail_broken("ends within its header", place);
  header.begin = 8 + length_bytes + length;
  read_dictionary(bytes.substr(8 + length_bytes, length), place, header);
  for (const std::size_t extent : header.shape)
    if (__builtin_mul_overflow(header.count, extent, &header.count))
      fail_broken("has a shape that no memory holds", place);
  if (header.type.find('O') != std::string::npos) fail_pickled(place);
  header.big_endian = header.type.starts_with('>');
  return header;
}

// The values' bytes, exactly as many as the shape says.
std::string_view values_of(std::string_view bytes, const Header& header, std::size_t value_bytes,
                           const NpyPlace& place) {
  const std::string_view rest = bytes.substr(header.begin);
  std::size_t wanted = 0;
  if (__builtin_mul_overflow(header.count, value_bytes, &wanted)) fail_broken("has a shape no memory holds", place);
  if (rest.size() != wanted)
    fail_broken(fmt::format("has {} bytes of values, its shape and type say {}", rest.size(), wanted), place);
  return rest;
}

// The array in C order; `value(i)` is the i-th in the order of the file.
template <class T, class Value>
NpyArray<T> in_c_order(const Header& header, const Value& value) {
  NpyArray<T> array;
  array.shape.assign(header.shape.begin(), header.shape.end());
  array.values.resize(header.count);
  const std::size_t rank = header.shape.size();
  if (!header.fortran_order || rank < 2) {
    for (std::size_t i = 0; i < header.count; ++i) array.values[i] = value(i);
    return array;
  }
  std::vector<std::size_t> stride(rank, 1), index(rank, 0);  // distance in the file from one index to the next
  for (std::size_t k = 1; k < rank; ++k) stride[k] = stride[k - 1] * header.shape[k - 1];
  std::size_t from = 0;
  for (std::size_t i = 0; i < header.count; ++i) {
    array.values[i] = value(from);
    for (std::size_t k = rank; k-- > 0;) {
      from += stride[k];
      if (++index[k] < header.shape[k]) break;
      from -= stride[k] * header.shape[k];
      index[k] = 0;
    }
  }
  return array;
}

// Calls `use` with a value of the type that a number is stored as; false for other types.
template <class Use>
bool with_number_type(const std::string& type, const Use& use) {
  const std::string plain = type.empty() ? "" : type.substr(type.find_first_not_of("<>|=") == 0 ? 0 : 1);
  if (plain == "f8") return use(double{}), true;
  if (plain == "f4") return use(float{}), true;
  if (plain == "f2") return use(Half{}), true;
  if (plain == "i8") return use(std::int64_t{}), true;
  if (plain == "i4") return use(std::int32_t{}), true;
  if (plain == "i2") return use(std::int16_t{}), true;
  if (plain == "i1") return use(std::int8_t{}), true;
  if (plain == "u8") return use(std::uint64_t{}), true;
  if (plain == "u4") return use(std::uint32_t{}), true;
  if (plain == "u2") return use(std::uint16_t{}), true;
  if (plain == "u1" || plain == "b1") return use(std::uint8_t{}), true;
  return false;
}

// The i-th value as the machine has it.
template <class Stored>
Stored value_at(std::string_view values, std::size_t i, bool big_endian) {
  std::array<char, sizeof(Stored)> bytes;
  std::memcpy(bytes.data(), values.data() + i * bytes.size(), bytes.size());
  if (big_endian) std::ranges::reverse(bytes);
  return std::bit_cast<Stored>(bytes);
}

// `convert` turns a stored value into a T.
template <class T, class Convert>
NpyArray<T> read_array(std::string_view bytes, const NpyPlace& place, const Convert& convert) {
  const Header header = read_header(bytes, place);
  NpyArray<T> array;
  const bool known = with_number_type(header.type, [&]<class Stored>(Stored) {
    const std::string_view values = values_of(bytes, header, sizeof(Stored), place);
    array = in_c_order<T>(header, [&](std::size_t i) {
      const auto value = value_at<Stored>(values, i, header.big_endian);
      if constexpr (std::is_same_v<Stored, Half>)
        return convert(half_value(value.word));
      else
        return convert(value);
    });
  });
  if (!known)
    throw Error(fmt::format("has values of type {}, not numbers that are read", header.type), place.text(),
                "save it with .astype(float), or .astype(int) for indices");
  return array;
}

void append_utf8(std::string& text, std::uint32_t code) {
  const auto put = [&](std::uint32_t byte) { text += static_cast<char>(byte); };
  if (code < 0x80) return put(code);
  if (code < 0x800) {
    put(0xC0 | code >> 6);
  } else {
    if (code < 0x10000) {
      put(0xE0 | code >> 12);
    } else {
      put(0xF0 | (code >> 18 & 7));
      put(0x80 | (code >> 12 & 0x3F));
    }
    put(0x80 | (code >> 6 & 0x3F));
  }
  put(0x80 | (code & 0x3F));
}

}  // namespace

NpyArray<double> npy_numbers(std::string_view bytes, const NpyPlace& place) {
  return read_array<double>(bytes, place, [](auto value) { return static_cast<double>(value); });
}

NpyArray<std::int64_t> npy_integers(std::string_view bytes, const NpyPlace& place) {
  constexpr double largest = 9007199254740992;  // 2^53: up to here doubles have every integer
  return read_array<std::int64_t>(bytes, place, [&](auto value) {
    if constexpr (std::is_floating_point_v<decltype(value)>) {
      if (!(std::abs(value) <= largest) || std::trunc(value) != value)
        throw Error(fmt::format("has the value {}, which is no index", value), place.text(), "save whole numbers");
    } else if constexpr (std::is_same_v<decltype(value), std::uint64_t>) {
      if (value > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max()))
        throw Error(fmt::format("has the value {}, which is no index", value), place.text(), "save it as int64");
    }
    return static_cast<std::int64_t>(value);
  });
}

NpyArray<std::string> npy_texts(std::string_view bytes, const NpyPlace& place) {
  const Header header = read_header(bytes, place);
  const std::size_t kind = header.type.find_first_of("SU");
  std::size_t length = 0;
  if (kind == std::string::npos ||
      std::from_chars(&header.type[kind] + 1, header.type.data() + header.type.size(), length).ec != std::errc())
    throw Error(fmt::format("has values of type {}, not texts", header.type), place.text(), "save it as text");
  const std::size_t unit = header.type[kind] == 'U' ? 4 : 1;
  if (length > bytes.size()) fail_broken("is shorter than one of its texts", place);
  if (length == 0 && header.count > 0) fail_broken("has texts of no length", place);
  const std::string_view values = values_of(bytes, header, unit * length, place);
  return in_c_order<std::string>(header, [&](std::size_t i) {
    const std::string_view padded = values.substr(i * unit * length, unit * length);
    if (unit == 1) return std::string(padded.substr(0, padded.find_last_not_of('\0') + 1));
    std::string text;
    for (std::size_t k = 0; k < length; ++k)
      if (const auto code = value_at<std::uint32_t>(padded, k, header.big_endian); code != 0) append_utf8(text, code);
    return text;
  });
}

}  // namespace selvedge
