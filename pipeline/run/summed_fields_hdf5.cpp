#include "pipeline/run/summed_fields_hdf5.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "collision/geometry/error.hpp"
#include "pipeline/host/bytes_of.hpp"
#include "pipeline/host/kept_rows.hpp"

namespace selvedge::h5 {
void SummedFields::add(const std::string& name, std::string_view bytes) {
  sum = hash_of(bytes, hash_of(fmt::format("{:016x} {} ", sum, name)));
}

void SummedFieldsOut::numbers(const std::string& name, const std::vector<double>& values) {
  write_numbers(file, name, values);
  add(name, bytes_of(values));
}

void SummedFieldsOut::floats(const std::string& name, const std::vector<float>& values) {
  file.write_constant(name, H5T_NATIVE_FLOAT, {static_cast<hsize_t>(values.size())}, values.data());
  add(name, bytes_of(values));
}

void SummedFieldsOut::text(const std::string& name, const std::string& value) {
  file.write_text(name, value + ".");  // never empty
  add(name, value);
}

void SummedFieldsOut::points(const std::string& name, const Points& x) {
  numbers(name, std::vector<double>(x.data(), x.data() + x.size()));
}

void SummedFieldsOut::write_checksum() const { file.write_text("checksum", fmt::format("{:016x}", sum)); }

void SummedFieldsIn::fail(const std::string& what) const { throw Error(what, file.path().string(), cure); }

std::int64_t SummedFieldsIn::whole(const std::string& name, double value, double most) const {
  if (!(value >= 0 && value <= most) || value != std::floor(value))
    fail(fmt::format("`{}` has the value {:g}, not a whole number from 0 to {:g}", name, value, most));
  return static_cast<std::int64_t>(value);
}

void SummedFieldsIn::need(const std::string& name) const {
  if (!file.has(name)) fail("the field `" + name + "` is missing");
}

template <class T>
std::vector<T> SummedFieldsIn::list(const std::string& name, hid_t type) {
  need(name);
  std::vector<T> values(static_cast<std::size_t>(file.shape_of(name, 1)[0]));
  if (!values.empty()) file.read_all(name, type, {values.size()}, values.data());
  add(name, bytes_of(values));
  return values;
}

std::vector<double> SummedFieldsIn::numbers(const std::string& name) { return list<double>(name, H5T_NATIVE_DOUBLE); }

std::vector<float> SummedFieldsIn::floats(const std::string& name) { return list<float>(name, H5T_NATIVE_FLOAT); }

std::string SummedFieldsIn::text(const std::string& name) {
  need(name);
  std::string value = file.read_text(name);
  if (value.empty()) fail("the field `" + name + "` is empty");
  value.pop_back();
  add(name, value);
  return value;
}

Points SummedFieldsIn::points(const std::string& name) {
  const std::vector<double> values = numbers(name);
  if (values.size() % 3 != 0) fail("the field `" + name + "` has no rows of three");
  if (!std::ranges::all_of(values, [](double v) { return std::abs(v) <= 1e6; }))
    fail("the field `" + name + "` has values that are not finite or absurdly large");
  return Eigen::Map<const Points>(values.data(), static_cast<Eigen::Index>(values.size() / 3), 3);
}

void SummedFieldsIn::check_checksum() const {
  if (fmt::format("{:016x}", sum) != file.read_text("checksum")) fail("its checksum is wrong: it is damaged");
}

}  // namespace selvedge::h5
