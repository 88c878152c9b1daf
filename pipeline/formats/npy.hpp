#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace selvedge {

// An array as numpy stores it, in C order: the last index runs fastest.
template <class T>
struct NpyArray {
  std::vector<Eigen::Index> shape;  // empty: a single value
  std::vector<T> values;
};

// The source of an array, for errors.
struct NpyPlace {
  std::string file, field;

  std::string text() const { return file + ": " + field; }
};

// Arrays from the bytes of an .npy file (format versions 1 to 3 of numpy.lib.format), stored in C or Fortran order,
// little-endian or big-endian. Throws Error for bytes that are no such file or do not have the length that the shape
// says, for pickled Python objects (which are never read), and for values of another kind.

// Floats of 16, 32 and 64 bits, integers and booleans.
NpyArray<double> npy_numbers(std::string_view bytes, const NpyPlace&);

// Integers, booleans, and floats whose values are whole.
NpyArray<std::int64_t> npy_integers(std::string_view bytes, const NpyPlace&);

// Unicode and byte strings, as UTF-8.
NpyArray<std::string> npy_texts(std::string_view bytes, const NpyPlace&);

}  // namespace selvedge
