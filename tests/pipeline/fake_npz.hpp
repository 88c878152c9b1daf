#pragma once

#include <zip.h>

#include <cstring>
#include <filesystem>
#include <map>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

namespace selvedge::fake {

// An .npy file from its parts, by the description of the format.
inline std::string npy_of(const std::string& descr, bool fortran, const std::string& shape, const std::string& values,
                          int version = 1) {
  std::string header =
      "{'descr': " + descr + ", 'fortran_order': " + (fortran ? "True" : "False") + ", 'shape': " + shape + ", }";
  const std::size_t begin = version == 1 ? 10 : 12;
  while ((begin + header.size() + 1) % 64 != 0) header += ' ';
  header += '\n';
  std::string bytes = "\x93NUMPY";
  bytes += static_cast<char>(version);
  bytes += '\0';
  for (std::size_t k = 0; k < begin - 8; ++k) bytes += static_cast<char>(header.size() >> (8 * k) & 0xFF);
  return bytes + header + values;
}

template <class T>
std::string npy_type() {
  const char kind = std::is_same_v<T, bool> ? 'b' : std::is_floating_point_v<T> ? 'f' : std::is_signed_v<T> ? 'i' : 'u';
  return std::string("'") + (sizeof(T) == 1 ? '|' : '<') + kind + std::to_string(sizeof(T)) + "'";
}

inline std::string npy_shape(const std::vector<std::size_t>& shape) {
  std::string text = "(";
  for (const std::size_t extent : shape) text += std::to_string(extent) + ", ";
  return text + ")";
}

// `values` in C order.
template <class T>
std::string npy(const std::vector<std::size_t>& shape, const std::vector<T>& values, int version = 1) {
  std::string bytes;
  for (const T value : values) {
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    bytes.append(raw, sizeof(T));
  }
  return npy_of(npy_type<T>(), false, npy_shape(shape), bytes, version);
}

using NpzEntries = std::map<std::string, std::string>;  // names without .npy, and .npy files

inline std::filesystem::path write_npz(const std::filesystem::path& path, const NpzEntries& entries,
                                       bool compressed = false) {
  int error = 0;
  zip_t* zip = zip_open(path.c_str(), ZIP_CREATE | ZIP_TRUNCATE, &error);
  if (!zip) throw std::runtime_error("cannot write " + path.string());
  for (const auto& [name, bytes] : entries) {
    zip_source_t* source = zip_source_buffer(zip, bytes.data(), bytes.size(), 0);
    const zip_int64_t index = zip_file_add(zip, (name + ".npy").c_str(), source, ZIP_FL_ENC_UTF_8);
    zip_set_file_compression(zip, static_cast<zip_uint64_t>(index), compressed ? ZIP_CM_DEFLATE : ZIP_CM_STORE, 0);
  }
  if (zip_close(zip) != 0) throw std::runtime_error("cannot write " + path.string());
  return path;
}

}  // namespace selvedge::fake
