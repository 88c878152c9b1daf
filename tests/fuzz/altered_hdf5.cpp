#include "tests/fuzz/altered_hdf5.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>

namespace selvedge::fuzz {
namespace {

// Takes a fuzzer's bytes one after the other; zero where they are at an end.
struct Choices {
  const std::uint8_t* next;
  const std::uint8_t* end;
  bool any() const { return next < end; }
  unsigned byte() { return next < end ? *next++ : 0; }
};

hid_t text_of_length(std::size_t length) {
  const hid_t type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, length);
  return type;
}

hid_t pair_type() {
  const hid_t type = H5Tcreate(H5T_COMPOUND, 16);
  H5Tinsert(type, "a", 0, H5T_NATIVE_DOUBLE);
  H5Tinsert(type, "b", 8, H5T_NATIVE_INT64);
  return type;
}

// Types that a field may have instead of its own; never closed, they are few.
const std::vector<hid_t>& types() {
  static const std::vector<hid_t> all = {H5T_STD_I8LE,
                                         H5T_STD_U8LE,
                                         H5T_STD_I16BE,
                                         H5T_STD_I32LE,
                                         H5T_STD_I64LE,
                                         H5T_STD_U64BE,
                                         H5T_IEEE_F32LE,
                                         H5T_IEEE_F64BE,
                                         H5T_NATIVE_LDOUBLE,
                                         H5T_STD_B8LE,
                                         text_of_length(1),
                                         text_of_length(3),
                                         text_of_length(64),
                                         text_of_length(100000),
                                         H5Tcreate(H5T_OPAQUE, 5),
                                         pair_type(),
                                         text_of_length(H5T_VARIABLE),
                                         H5Tvlen_create(H5T_NATIVE_INT)};
  return all;
}

hsize_t altered_extent(hsize_t extent, unsigned how) {
  const std::array<hsize_t, 12> choices = {0,
                                           1,
                                           2,
                                           3,
                                           4,
                                           extent + 1,
                                           extent > 0 ? extent - 1 : 0,
                                           2 * extent,
                                           1000,
                                           hsize_t{1} << 31,
                                           hsize_t{1} << 33,
                                           hsize_t{1} << 61};
  return choices[how % choices.size()];
}

double altered_value(unsigned how) {
  const std::array<double, 14> choices = {0,
                                          -1,
                                          1,
                                          2,
                                          3,
                                          255,
                                          -2147483648.0,
                                          2147483647.0,
                                          4294967296.0,
                                          1e18,
                                          1e308,
                                          1e-308,
                                          std::numeric_limits<double>::quiet_NaN(),
                                          std::numeric_limits<double>::infinity()};
  return choices[how % choices.size()];
}

bool is_number(hid_t type) {
  const H5T_class_t kind = H5Tget_class(type);
  return kind == H5T_INTEGER || kind == H5T_FLOAT;
}

// The dataset, with as many values as are given from its begin on; one that is too large for memory has none.
void write_field(hid_t file, const std::string& name, hid_t type, const std::vector<hsize_t>& shape, bool chunked,
                 bool empty, std::vector<char> values) {
  constexpr hsize_t most_bytes = 1 << 20;
  const hid_t space = empty           ? H5Screate(H5S_NULL)
                      : shape.empty() ? H5Screate(H5S_SCALAR)
                                      : H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr);
  const hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
  hsize_t bytes = H5Tget_size(type);
  bool large = false;
  for (const hsize_t extent : shape) large = __builtin_mul_overflow(bytes, extent, &bytes) || large;
  large = large || bytes > most_bytes;
  if (!empty && !shape.empty() && (chunked || large)) {
    std::vector<hsize_t> chunk;
    for (const hsize_t extent : shape) chunk.push_back(std::clamp<hsize_t>(extent, 1, 4));
    H5Pset_chunk(creation, static_cast<int>(chunk.size()), chunk.data());
  }
  const hid_t dataset = H5Dcreate2(file, name.c_str(), type, space, H5P_DEFAULT, creation, H5P_DEFAULT);
  if (dataset >= 0 && !large && !empty && bytes > 0 && H5Tdetect_class(type, H5T_VLEN) <= 0 &&
      H5Tis_variable_str(type) <= 0) {
    values.resize(bytes, '\1');
    H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  }
  if (dataset >= 0) H5Dclose(dataset);
  H5Pclose(creation);
  H5Sclose(space);
}

herr_t note_object(hid_t, const char* name, const H5O_info_t* info, void* lists) {
  auto& [groups, datasets] = *static_cast<std::pair<std::vector<std::string>, std::vector<std::string>>*>(lists);
  if (info->type == H5O_TYPE_GROUP && std::strcmp(name, ".") != 0) groups.emplace_back(name);
  if (info->type == H5O_TYPE_DATASET) datasets.emplace_back(name);
  return 0;
}

hid_t latest_format() {
  static const hid_t access = [] {
    const hid_t list = H5Pcreate(H5P_FILE_ACCESS);
    H5Pset_libver_bounds(list, H5F_LIBVER_LATEST, H5F_LIBVER_LATEST);
    return list;
  }();
  return access;
}

}  // namespace

AlteredHdf5::AlteredHdf5(const std::filesystem::path& valid) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  const hid_t file = H5Fopen(valid.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  const hid_t creation = H5Fget_create_plist(file);
  H5Pget_userblock(creation, &user_block_);
  H5Pclose(creation);
  std::pair<std::vector<std::string>, std::vector<std::string>> names;
  H5Ovisit2(file, H5_INDEX_NAME, H5_ITER_INC, note_object, &names, H5O_INFO_BASIC);
  groups_ = names.first;
  for (const std::string& name : names.second) {
    const hid_t dataset = H5Dopen2(file, name.c_str(), H5P_DEFAULT), space = H5Dget_space(dataset);
    Field field{name, H5Dget_type(dataset), {}, {}};
    field.shape.resize(static_cast<std::size_t>(H5Sget_simple_extent_ndims(space)));
    H5Sget_simple_extent_dims(space, field.shape.data(), nullptr);
    field.values.resize(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)) * H5Tget_size(field.type));
    if (!field.values.empty()) H5Dread(dataset, field.type, H5S_ALL, H5S_ALL, H5P_DEFAULT, field.values.data());
    H5Sclose(space);
    H5Dclose(dataset);
    fields_.push_back(std::move(field));
  }
  H5Fclose(file);
}

// Four bytes an alteration: which field, whether its type, its shape or its values, where, and the new value.
void AlteredHdf5::write(const std::uint8_t* bytes, std::size_t size, const std::filesystem::path& path) const {
  struct Alteration {
    unsigned what = 0, where = 0, to = 0;
  };
  std::vector<std::vector<Alteration>> of(fields_.size());
  Choices choices{bytes, bytes + std::min<std::size_t>(size, 64)};
  while (choices.any()) {
    auto& list = of[choices.byte() % of.size()];
    const unsigned what = choices.byte(), where = choices.byte();
    list.push_back({what, where, choices.byte()});
  }
  const hid_t creation = H5Pcreate(H5P_FILE_CREATE);
  H5Pset_userblock(creation, user_block_);
  const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation, latest_format());
  H5Pclose(creation);
  for (const std::string& group : groups_)
    H5Gclose(H5Gcreate2(file, group.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  for (std::size_t f = 0; f < fields_.size(); ++f) {
    Field field = fields_[f];
    bool left_out = false, empty = false, chunked = false;
    for (const Alteration& a : of[f]) switch (a.what % 8) {
        case 0:
        case 1:  // a value
          if (is_number(field.type) && !field.values.empty()) {
            double value = altered_value(a.to);
            std::array<char, 32> raw{};
            std::memcpy(raw.data(), &value, sizeof value);
            H5Tconvert(H5T_NATIVE_DOUBLE, field.type, 1, raw.data(), nullptr, H5P_DEFAULT);
            const std::size_t width = H5Tget_size(field.type), count = field.values.size() / width;
            if (count == 0) break;  // the type has become another one
            std::memcpy(&field.values[a.where % count * width], raw.data(), width);
          } else if (!field.values.empty()) {
            field.values[(a.where * 7) % field.values.size()] = static_cast<char>(a.to);
          }
          break;
        case 2:
        case 3:  // an extent
          if (!field.shape.empty()) {
            hsize_t& extent = field.shape[a.where % field.shape.size()];
            extent = altered_extent(extent, a.to);
          }
          break;
        case 4:  // the rank
          if (a.where % 2 == 0 && field.shape.size() < 6)
            field.shape.insert(field.shape.begin() + static_cast<std::ptrdiff_t>(a.to % (field.shape.size() + 1)),
                               altered_extent(1, a.to / 8));
          else if (!field.shape.empty())
            field.shape.pop_back();
          break;
        case 5:
          field.type = types()[a.to % types().size()];
          break;
        case 6:
          chunked = a.where % 2 == 0;
          empty = a.to % 4 == 0;
          break;
        default:
          left_out = true;
      }
    if (!left_out) write_field(file, field.name, field.type, field.shape, chunked, empty, field.values);
  }
  H5Fclose(file);
}

}  // namespace selvedge::fuzz
