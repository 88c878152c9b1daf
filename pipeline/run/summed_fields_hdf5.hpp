#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pipeline/hdf5/hdf5_fields.hpp"

namespace selvedge::h5 {

// Fields that are read in the order in which they were written, with a checksum of all of them at the end.
struct SummedFields {
  const File& file;
  std::uint64_t sum = 0;  // of the fields so far

  void add(const std::string& name, std::string_view bytes);
};

struct SummedFieldsOut : SummedFields {
  void numbers(const std::string& name, const std::vector<double>&);
  void floats(const std::string& name, const std::vector<float>&);
  void text(const std::string& name, const std::string&);
  void points(const std::string& name, const Points&);
  void write_checksum() const;
};

// What is missing, damaged or absurd throws Error with the file and the cure.
struct SummedFieldsIn : SummedFields {
  std::string cure;

  [[noreturn]] void fail(const std::string& what) const;
  // A count that was written as a floating-point number: whole, from 0 to `most`.
  std::int64_t whole(const std::string& name, double value, double most) const;
  std::vector<double> numbers(const std::string& name);
  std::vector<float> floats(const std::string& name);
  std::string text(const std::string& name);
  Points points(const std::string& name);  // finite, at most 1e6
  void check_checksum() const;             // after the last field

 private:
  void need(const std::string& name) const;
  template <class T>
  std::vector<T> list(const std::string& name, hid_t type);
};

}  // namespace selvedge::h5
