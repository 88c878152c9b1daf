#include "learned/network/weights_hdf5.hpp"

#include <hdf5.h>

#include <Eigen/Core>
#include <cstring>

#include "collision/geometry/error.hpp"
#include "collision/geometry/path_beside.hpp"
#include "learned/network/architecture_text.hpp"
#include "learned/network/nowhere_hdf5.hpp"
#include "learned/network/weight_seal.hpp"

namespace selvedge {
namespace {

constexpr const char* form_name = "selvedge weights 1";
constexpr long long bytes_of_half = 2;
constexpr hsize_t most_text = 1 << 24, most_texts = 4096;

// An HDF5 identifier of one kind that closes itself.
template <herr_t (*Close)(hid_t)>
struct Hdf5Id {
  hid_t id;
  explicit Hdf5Id(hid_t opened) : id(opened) {}
  Hdf5Id(const Hdf5Id&) = delete;
  ~Hdf5Id() {
    if (id >= 0) Close(id);
  }
};
using FileId = Hdf5Id<H5Fclose>;
using DatasetId = Hdf5Id<H5Dclose>;
using SpaceId = Hdf5Id<H5Sclose>;
using TypeId = Hdf5Id<H5Tclose>;
using PropertyId = Hdf5Id<H5Pclose>;

// An open file with its name for errors.
struct WeightStore {
  FileId file;
  std::string name;

  [[noreturn]] void fail(const std::string& field, const std::string& what) const {
    throw Error(what, name + ": " + field, "write or import the weights again");
  }
  hid_t good(hid_t result, const std::string& field, const char* what) const {
    if (result < 0) fail(field, what);
    return result;
  }
};

std::vector<hsize_t> shape_of(const WeightStore& store, hid_t dataset, const std::string& field) {
  const SpaceId space(store.good(H5Dget_space(dataset), field, "has no shape"));
  const int rank = H5Sget_simple_extent_ndims(space.id);
  if (rank < 0 || rank > 2) store.fail(field, "its rank is " + std::to_string(rank) + ", not 0 to 2");
  std::vector<hsize_t> shape(static_cast<std::size_t>(rank));
  H5Sget_simple_extent_dims(space.id, shape.data(), nullptr);
  return shape;
}

// Throws Error unless the values lie in this file as one block: no links to other files, external storage or
// compression.
void check_storage(const WeightStore& store, hid_t dataset, const std::string& field) {
  const PropertyId creation(store.good(H5Dget_create_plist(dataset), field, "cannot be read"));
  if (H5Pget_layout(creation.id) != H5D_CONTIGUOUS || H5Pget_external_count(creation.id) != 0)
    store.fail(field, "it is stored in a form that this program does not write");
  std::vector<char> owner(store.name.size() + 2);
  if (H5Fget_name(dataset, owner.data(), owner.size()) < 0 || store.name != owner.data())
    store.fail(field, "it lies in another file");
}

hid_t open_dataset(const WeightStore& store, const std::string& field) {
  return store.good(H5Dopen2(store.file.id, field.c_str(), H5P_DEFAULT), field, "is missing");
}

// IEEE 754's binary16, little-endian: HDF5 converts it, but has no name for it before version 1.14.4.
hid_t half_type() {
  const hid_t type = H5Tcopy(H5T_IEEE_F32LE);
  H5Tset_fields(type, 15, 10, 5, 0, 10);
  H5Tset_size(type, 2);
  H5Tset_ebias(type, 15);
  return type;
}

// `data` has the type `memory` and is stored as `type`.
void write_dataset(const WeightStore& store, const std::string& field, hid_t type, hid_t memory,
                   const std::vector<hsize_t>& shape, const void* data) {
  const PropertyId links(H5Pcreate(H5P_LINK_CREATE));
  H5Pset_create_intermediate_group(links.id, 1);
  const PropertyId creation(H5Pcreate(H5P_DATASET_CREATE));
  H5Pset_obj_track_times(creation.id, false);  // the same content gives the same bytes at any time
  const SpaceId space(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr));
  const DatasetId dataset(
      store.good(H5Dcreate2(store.file.id, field.c_str(), type, space.id, links.id, creation.id, H5P_DEFAULT), field,
                 "cannot be written"));
  store.good(H5Dwrite(dataset.id, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, data), field, "cannot be written");
}

void write_texts(const WeightStore& store, const std::string& field, const std::vector<std::string>& texts) {
  std::size_t width = 1;
  for (const std::string& text : texts) width = std::max(width, text.size());
  const TypeId type(H5Tcopy(H5T_C_S1));
  H5Tset_size(type.id, width);
  H5Tset_strpad(type.id, H5T_STR_NULLPAD);
  std::vector<char> padded(width * texts.size() + 1, '\0');
  for (std::size_t i = 0; i < texts.size(); ++i) std::memcpy(&padded[i * width], texts[i].data(), texts[i].size());
  write_dataset(store, field, type.id, type.id, {texts.size()}, padded.data());
}

std::vector<std::string> read_texts(const WeightStore& store, const std::string& field) {
  const DatasetId dataset(open_dataset(store, field));
  const std::vector<hsize_t> shape = shape_of(store, dataset.id, field);
  const TypeId type(store.good(H5Dget_type(dataset.id), field, "has no type"));
  if (H5Tget_class(type.id) != H5T_STRING || H5Tis_variable_str(type.id) != 0 || shape.size() != 1)
    store.fail(field, "it is not a list of texts of fixed length");
  const std::size_t width = H5Tget_size(type.id);
  if (shape[0] > most_texts || width > most_text || width * shape[0] > most_text)
    store.fail(field, "its texts are longer than " + std::to_string(most_text) + " bytes");
  std::vector<char> padded(width * shape[0] + 1, '\0');
  if (shape[0] > 0) {
    check_storage(store, dataset.id, field);
    store.good(H5Dread(dataset.id, type.id, H5S_ALL, H5S_ALL, H5P_DEFAULT, padded.data()), field, "cannot be read");
  }
  std::vector<std::string> texts;
  for (hsize_t i = 0; i < shape[0]; ++i) texts.emplace_back(&padded[i * width], strnlen(&padded[i * width], width));
  return texts;
}

std::string read_text(const WeightStore& store, const std::string& field) {
  const std::vector<std::string> texts = read_texts(store, field);
  if (texts.size() != 1) store.fail(field, "it is not one text");
  return texts.front();
}

std::vector<hsize_t> wanted_shape(const WeightArray& array, bool matrix) {
  const auto rows = static_cast<hsize_t>(array.rows), columns = static_cast<hsize_t>(array.columns);
  return matrix ? std::vector<hsize_t>{rows, columns} : std::vector<hsize_t>{rows};
}

bool is_matrix(const WeightArray& array) {
  return array.name.ends_with("/weight") || array.name.starts_with("embeddings/");
}

void read_array(const WeightStore& store, const WeightArray& array) {
  const std::string field = "weights/" + array.name;
  const DatasetId dataset(open_dataset(store, field));
  if (shape_of(store, dataset.id, field) != wanted_shape(array, is_matrix(array)))
    store.fail(field, "its shape is not what the architecture asks for");
  const TypeId type(store.good(H5Dget_type(dataset.id), field, "has no type"));
  const TypeId half(half_type());
  if (H5Tequal(type.id, H5T_IEEE_F32LE) <= 0 && H5Tequal(type.id, half.id) <= 0)
    store.fail(field, "its values are neither 32-bit nor 16-bit floats");
  check_storage(store, dataset.id, field);
  store.good(H5Dread(dataset.id, H5T_NATIVE_FLOAT, H5S_ALL, H5S_ALL, H5P_DEFAULT, array.data), field, "cannot be read");
}

bool stored_half(const WeightArray& array, WeightStorage storage) {
  return storage == WeightStorage::half && array.trained;
}

constexpr float largest_half = 65504, smallest_normal_half = 0x1p-14f;

// HDF5 1.10 converts numbers below the smallest normal half wrongly. They become zero.
void drop_small(const WeightArray& array) {
  Eigen::Map<Eigen::ArrayXf> values(array.data, Eigen::Index{array.rows} * array.columns);
  values = (values.abs() < smallest_normal_half).select(0.f, values);
}

void require_half_range(const WeightFile& content, const std::string& where) {
  NetworkWeights weights = content.weights;
  for (const WeightArray& array : weight_arrays(content.architecture, weights)) {
    const Eigen::Map<const Eigen::ArrayXf> values(array.data, Eigen::Index{array.rows} * array.columns);
    if (stored_half(array, WeightStorage::half) && !(values.abs() <= largest_half).all())
      throw Error("a weight of " + array.name + " is not finite or larger than 65,504, the largest half", where,
                  "store the weights as 32-bit floats");
  }
}

void write_fields(const WeightStore& store, const WeightFile& content, WeightStorage storage) {
  write_texts(store, "format", {form_name});
  write_texts(store, "version", {content.version});
  write_texts(store, "architecture", {architecture_text(content.architecture)});
  write_texts(store, "training", {content.training});
  if (!content.trained_on.empty()) write_texts(store, "trained_on", {content.trained_on});
  std::vector<std::string> names, values;
  for (const auto& [name, value] : content.origin) names.push_back(name), values.push_back(value);
  write_texts(store, "origin_names", names);
  write_texts(store, "origin_values", values);
  NetworkWeights weights = content.weights;
  const TypeId half(half_type());
  for (const WeightArray& array : weight_arrays(content.architecture, weights)) {
    if (stored_half(array, storage)) drop_small(array);
    write_dataset(store, "weights/" + array.name, stored_half(array, storage) ? half.id : H5T_IEEE_F32LE,
                  H5T_NATIVE_FLOAT, wanted_shape(array, is_matrix(array)), array.data);
  }
}

void write_content(const std::filesystem::path& path, const WeightFile& content, WeightStorage storage) {
  const PropertyId creation(H5Pcreate(H5P_FILE_CREATE));
  H5Pset_userblock(creation.id, seal_bytes);
  const WeightStore store{FileId(H5Fcreate(path.c_str(), H5F_ACC_EXCL, creation.id, H5P_DEFAULT)), path.string()};
  if (store.file.id < 0) throw Error("cannot write", path_in_place(path).string(), write_cure);
  try {
    write_fields(store, content, storage);
    store.good(H5Fflush(store.file.id, H5F_SCOPE_LOCAL), "end of the file", "cannot be written");
  } catch (const Error&) {  // names a field, which is not at fault
    write_nowhere(store.file.id);
    throw Error("cannot write all of it", path_in_place(path).string(), write_cure);
  }
}

// Removes the file unless it was renamed.
struct FileBeside {
  std::filesystem::path path;
  ~FileBeside() {
    std::error_code ignored;
    std::filesystem::remove(path, ignored);
  }
};

void require_fitting_architecture(const WeightStore& store, const Architecture& a, long long bytes) {
  if (parameter_count(a) > bytes / bytes_of_half)
    store.fail("architecture",
               "it asks for " + std::to_string(parameter_count(a)) + " numbers, which is more than the file can hold");
}

}  // namespace

void write_weight_file(const std::filesystem::path& path, const WeightFile& content, WeightStorage storage) {
  check_architecture(content.architecture, path.string());
  check_weights(content.architecture, content.weights, path.string());
  if (storage == WeightStorage::half) require_half_range(content, path.string());
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  const FileBeside beside{path_beside(path)};
  write_content(beside.path, content, storage);
  write_seal(beside.path);
  std::error_code error;
  std::filesystem::rename(beside.path, path, error);
  if (error) throw Error("cannot write (" + error.message() + ")", path.string(), write_cure);
}

WeightFile read_weight_file(const std::filesystem::path& path) {
  const long long bytes = check_seal(path);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  const WeightStore store{FileId(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT)), path.string()};
  if (store.file.id < 0)
    throw Error("cannot open as HDF5", path.string(), "the file is damaged: copy or make it again");
  if (read_text(store, "format") != form_name) store.fail("format", "it is not `" + std::string(form_name) + "`");
  WeightFile content;
  content.version = read_text(store, "version");
  content.training = read_text(store, "training");
  if (H5Lexists(store.file.id, "trained_on", H5P_DEFAULT) > 0) content.trained_on = read_text(store, "trained_on");
  content.architecture = parse_architecture(read_text(store, "architecture"), path.string() + ": architecture");
  require_fitting_architecture(store, content.architecture, bytes);
  const std::vector<std::string> names = read_texts(store, "origin_names"), values = read_texts(store, "origin_values");
  if (names.size() != values.size()) store.fail("origin_values", "their number is not that of the names");
  for (std::size_t i = 0; i < names.size(); ++i) content.origin.emplace_back(names[i], values[i]);
  content.weights = blank_weights(content.architecture);
  for (const WeightArray& array : weight_arrays(content.architecture, content.weights)) read_array(store, array);
  return content;
}

}  // namespace selvedge
