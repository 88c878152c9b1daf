#include "pipeline/hdf5/hdf5_handles.hpp"

#include <algorithm>
#include <cstring>
#include <memory>

#include "collision/geometry/error.hpp"
#include "collision/geometry/path_beside.hpp"
#include "collision/geometry/require_file.hpp"
#include "learned/network/nowhere_hdf5.hpp"
#include "pipeline/host/bounds.hpp"
#include "pipeline/host/cure_to_write.hpp"

namespace selvedge::h5 {
namespace {

// The deepest entry of the error stack has the system's reason ("... error message = 'No space left on device'").
std::string reason_of_failure() {
  std::string deepest;
  const auto keep_last = [](unsigned, const H5E_error2_t* entry, void* text) -> herr_t {
    if (entry->desc) *static_cast<std::string*>(text) = entry->desc;
    return 0;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_DOWNWARD, keep_last, &deepest);
  const std::string key = "error message = '";
  const std::size_t begin = deepest.find(key);
  if (begin == std::string::npos) return deepest;
  const std::size_t end = deepest.find('\'', begin + key.size());
  return deepest.substr(begin + key.size(), end - begin - key.size());
}

std::string cure_for(const std::string& reason) {
  if (reason.find("No such file") != std::string::npos) return "check the path";
  if (reason.find("signature not found") != std::string::npos)
    return "this is no HDF5 file, or one that was cut off at its beginning: name a .h5 file of this program";
  if (reason.find("truncated file") != std::string::npos) return "the end of the file is missing: copy it again";
  if (const std::string cure = cure_to_write(reason); cure != write_cure)
    return cure + "; what was written is readable up to the last full frame";
  if (reason.find("ermission") != std::string::npos) return "check who may write there, or choose another folder";
  return "check that the file is one of this program and that its disk works";
}

// Latest format (SWMR needs it), no file locks (network folders often lack them; this program allows one writer per
// file).
Handle file_access(H5F_libver_t earliest = H5F_LIBVER_LATEST) {
  Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_libver_bounds(access.id(), earliest, H5F_LIBVER_LATEST);
  H5Pset_file_locking(access.id(), false, true);
  // SWMR readers read metadata again while its checksum is wrong, and wait twice as long each time. The default of 100
  // times would never end with a file of a killed writer; this many take a second or two.
  H5Pset_metadata_read_attempts(access.id(), 30);
  return access;
}

// Properties of what is created without its time, so that the same content gives the same bytes.
Handle untimed(hid_t kind) {
  Handle creation(H5Pcreate(kind), H5Pclose);
  H5Pset_obj_track_times(creation.id(), false);
  return creation;
}

// The system may cut a killed writer's last write between two memory pages. So metadata is kept within single pages,
// where a write is complete or absent.
Handle file_creation() {
  Handle creation = untimed(H5P_FILE_CREATE);
  H5Pset_file_space_strategy(creation.id(), H5F_FSPACE_STRATEGY_PAGE, false, 1);
  H5Pset_file_space_page_size(creation.id(), 4096);
  return creation;
}

// Access properties for datasets and links that never lead into another file.
Handle within_the_file(hid_t kind) {
  Handle access(H5Pcreate(kind), H5Pclose);
  H5Pset_elink_cb(
      access.id(),
      [](const char*, const char*, const char*, const char*, unsigned*, hid_t, void*) -> herr_t { return -1; },
      nullptr);
  return access;
}

std::string type_text(hid_t type) {
  const std::string bits = std::to_string(8 * H5Tget_size(type)) + "-bit ";
  const H5T_class_t kind = H5Tget_class(type);
  if (kind == H5T_INTEGER) return bits + "integers";
  if (kind == H5T_FLOAT) return bits + "floating-point numbers";
  if (kind == H5T_STRING) return "texts";
  return kind == H5T_COMPOUND ? "rows of named columns" : "values of another kind";
}

// The name of a dataset in its file.
std::string name_of(hid_t dataset) {
  std::string name(static_cast<std::size_t>(std::max<ssize_t>(H5Iget_name(dataset, nullptr, 0), 0)), '\0');
  if (!name.empty()) H5Iget_name(dataset, name.data(), name.size() + 1);
  return name.starts_with('/') ? name.substr(1) : name;
}

std::string shape_text(const std::vector<hsize_t>& shape) {
  std::string text;
  for (const hsize_t extent : shape) text += (text.empty() ? "" : " x ") + std::to_string(extent);
  return shape.empty() ? "a single value" : text;
}

// File and memory selections of whole rows.
struct Rows {
  Handle file, memory;
};

Rows select_rows(hid_t dataset, const std::vector<hsize_t>& shape, hsize_t first, hsize_t count) {
  std::vector<hsize_t> start(shape.size(), 0), extent = shape;
  start[0] = first;
  extent[0] = count;
  Rows rows{Handle(H5Dget_space(dataset), H5Sclose),
            Handle(H5Screate_simple(static_cast<int>(extent.size()), extent.data(), nullptr), H5Sclose)};
  H5Sselect_hyperslab(rows.file.id(), H5S_SELECT_SET, start.data(), nullptr, extent.data(), nullptr);
  return rows;
}

}  // namespace

hid_t checked(hid_t result, const std::filesystem::path& file, const std::string& doing) {
  if (result >= 0) return result;
  const std::string reason = reason_of_failure();
  throw Error("cannot " + doing + (reason.empty() ? "" : " (" + reason + ")"), path_in_place(file).string(),
              cure_for(reason));
}

void silence() { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }

Handle text_type(std::size_t length) {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type.id(), length);
  H5Tset_cset(type.id(), H5T_CSET_UTF8);
  H5Tset_strpad(type.id(), H5T_STR_NULLPAD);
  return type;
}

File File::create(const std::filesystem::path& path, bool followed) {
  silence();
  // In the latest format the root group has its time, whatever its properties say (HDF5 1.10).
  const Handle access = file_access(followed ? H5F_LIBVER_LATEST : H5F_LIBVER_EARLIEST), creation = file_creation();
  const hid_t id = H5Fcreate(path.c_str(), H5F_ACC_EXCL, creation.id(), access.id());
  if (id < 0) {
    const std::string reason = reason_of_failure();
    throw Error("cannot write (" + reason + ")", path_in_place(path).string(), cure_to_write(reason));
  }
  return {path, Handle(id, H5Fclose)};
}

File File::open(const std::filesystem::path& path) {
  require_file(path, "HDF5");
  silence();
  const Handle access = file_access();
  const hid_t id = H5Fopen(path.c_str(), H5F_ACC_RDONLY | H5F_ACC_SWMR_READ, access.id());
  return {path, Handle(checked(id, path, "open as HDF5"), H5Fclose)};
}

void File::move_to(const std::filesystem::path& path) {
  std::error_code error;
  std::filesystem::rename(path_, path, error);
  if (error) throw Error("cannot write (" + error.message() + ")", path.string(), cure_to_write(error.message()));
  path_ = path;
}

void File::flush() const { check(H5Fflush(id(), H5F_SCOPE_LOCAL), "write"); }

void File::start_swmr() const { check(H5Fstart_swmr_write(id()), "start writing"); }

void File::close() {
  if (id() < 0) return;
  flush();
  handle_.reset();
}

void File::abandon() {
  write_nowhere(id());
  handle_.reset();
}

void write_whole(const std::filesystem::path& path, const std::function<void(const File&)>& fields) {
  const std::filesystem::path beside = path_beside(path);
  File file = File::create(beside, false);
  try {
    fields(file);
    file.close();
    file.move_to(path);
  } catch (...) {
    file.abandon();
    std::error_code ignored;
    std::filesystem::remove(beside, ignored);
    throw;
  }
}

Handle File::make_group(const std::string& name) const {
  const Handle creation = untimed(H5P_GROUP_CREATE);
  return {check(H5Gcreate2(id(), name.c_str(), H5P_DEFAULT, creation.id(), H5P_DEFAULT), "make group " + name),
          H5Gclose};
}

void File::write_constant(const std::string& name, hid_t type, const std::vector<hsize_t>& shape,
                          const void* data) const {
  const Handle space(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr), H5Sclose);
  const Handle creation = untimed(H5P_DATASET_CREATE);
  const Handle dataset(
      check(H5Dcreate2(id(), name.c_str(), type, space.id(), H5P_DEFAULT, creation.id(), H5P_DEFAULT), "make " + name),
      H5Dclose);
  if (std::find(shape.begin(), shape.end(), hsize_t{0}) != shape.end()) return;
  check(H5Dwrite(dataset.id(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data), "write " + name);
}

void File::write_text(const std::string& name, const std::string& text) const {
  const std::string padded = text.empty() ? std::string(1, '\0') : text;
  const Handle type = text_type(padded.size());
  write_constant(name, type.id(), {1}, padded.data());
}

void File::write_texts(const std::string& name, const std::vector<std::string>& texts) const {
  std::size_t width = 1;
  for (const std::string& text : texts) width = std::max(width, text.size());
  std::vector<char> padded(width * texts.size(), '\0');
  for (std::size_t i = 0; i < texts.size(); ++i) std::memcpy(&padded[i * width], texts[i].data(), texts[i].size());
  const Handle type = text_type(width);
  write_constant(name, type.id(), {texts.size()}, padded.data());
}

Handle File::make_growing(const std::string& name, hid_t type, const std::vector<hsize_t>& row_shape,
                          hsize_t chunk_rows, hsize_t first_rows) const {
  std::vector<hsize_t> now{first_rows}, most{H5S_UNLIMITED}, chunk{chunk_rows};
  for (const hsize_t extent : row_shape) now.push_back(extent), most.push_back(extent), chunk.push_back(extent);
  const int rank = static_cast<int>(now.size());
  const Handle space(H5Screate_simple(rank, now.data(), most.data()), H5Sclose);
  const Handle creation = untimed(H5P_DATASET_CREATE);
  check(H5Pset_chunk(creation.id(), rank, chunk.data()), "set the chunks of " + name);
  return {
      check(H5Dcreate2(id(), name.c_str(), type, space.id(), H5P_DEFAULT, creation.id(), H5P_DEFAULT), "make " + name),
      H5Dclose};
}

Handle File::open_dataset(const std::string& name) const {
  const Handle access = within_the_file(H5P_DATASET_ACCESS);
  return {check(H5Dopen2(id(), name.c_str(), access.id()), "find " + name), H5Dclose};
}

bool File::has(const std::string& name) const {
  const Handle access = within_the_file(H5P_LINK_ACCESS);
  return H5Lexists(id(), name.c_str(), access.id()) > 0;
}

std::vector<hsize_t> File::shape(hid_t dataset) const {
  const Handle space(check(H5Dget_space(dataset), "read a shape"), H5Sclose);
  const int rank = H5Sget_simple_extent_ndims(space.id());
  check(rank, "read a shape");
  std::vector<hsize_t> shape(static_cast<std::size_t>(rank));
  H5Sget_simple_extent_dims(space.id(), shape.data(), nullptr);
  return shape;
}

void File::fail(const std::string& name, const std::string& what) const {
  throw Error(what, path_.string() + ": " + name, "the file is damaged or is none of this program; write it again");
}

// An attacker or a damaged file may declare any number of values. So the stored bytes must be enough for them at the
// best possible compression.
void File::check_stored(hid_t dataset, const std::string& name) const {
  constexpr hsize_t most_packed = 1032;  // most bytes that deflate packs into one
  constexpr hsize_t little = 1 << 20;    // bytes that are always allowed, since a file that is being written may lag
  const Handle type(check(H5Dget_type(dataset), "read the type of " + name), H5Tclose);
  const Handle creation(check(H5Dget_create_plist(dataset), "read how " + name + " is stored"), H5Pclose);
  if (H5Pget_external_count(creation.id()) != 0 || H5Pget_layout(creation.id()) == H5D_VIRTUAL)
    fail(name, "lies in other files");
  hsize_t wanted = H5Tget_size(type.id());
  for (const hsize_t extent : shape(dataset))
    if (__builtin_mul_overflow(wanted, extent, &wanted)) fail(name, "is larger than anything that can be stored");
  const hsize_t stored = H5Dget_storage_size(dataset);
  if (wanted > little && wanted / most_packed >= stored)
    fail(name, "declares " + std::to_string(wanted) + " bytes, of which " + std::to_string(stored) + " are stored");
}

// Columns that the file lacks are left as they are.
void File::check_type(hid_t dataset, hid_t wanted, const std::string& name) const {
  const Handle found(check(H5Dget_type(dataset), "read the type of " + name), H5Tclose);
  if (H5Tget_class(found.id()) != H5Tget_class(wanted))
    fail(name, "holds " + type_text(found.id()) + ", not " + type_text(wanted));
  if (H5Tget_class(wanted) != H5T_COMPOUND) return;
  for (int k = 0; k < H5Tget_nmembers(wanted); ++k) {
    const auto at = static_cast<unsigned>(k);
    const std::unique_ptr<char, herr_t (*)(void*)> column(H5Tget_member_name(wanted, at), H5free_memory);
    const int there = H5Tget_member_index(found.id(), column.get());
    if (there < 0) continue;
    const Handle own(H5Tget_member_type(wanted, at), H5Tclose),
        its(H5Tget_member_type(found.id(), static_cast<unsigned>(there)), H5Tclose);
    if (H5Tget_class(own.id()) != H5Tget_class(its.id()))
      fail(name + ", column " + column.get(), "holds " + type_text(its.id()) + ", not " + type_text(own.id()));
  }
}

std::vector<hsize_t> File::shape_of(const std::string& name, std::size_t rank, bool growing) const {
  const Handle dataset = open_dataset(name);
  const std::vector<hsize_t> found = shape(dataset.id());
  if (found.size() != rank)
    fail(name, "has " + std::to_string(found.size()) + " dimensions, not " + std::to_string(rank));
  if (growing) return found;
  check_stored(dataset.id(), name);
  double count = 1;
  for (const hsize_t extent : found) count *= static_cast<double>(extent);
  refuse_too_many(count, most_numbers, "values", path_.string() + ": " + name, "write less into it");
  return found;
}

std::string File::read_text(const std::string& name) const {
  const std::vector<std::string> texts = read_texts(name);
  return texts.empty() ? "" : texts.front();
}

// Texts that other programs write may be a single value without extents.
std::vector<std::string> File::read_texts(const std::string& name) const {
  const Handle dataset = open_dataset(name);
  const Handle type(check(H5Dget_type(dataset.id()), "read the type of " + name), H5Tclose);
  if (H5Tget_class(type.id()) != H5T_STRING || H5Tis_variable_str(type.id()) > 0)
    throw Error("a text is stored in a form this program does not write", path_.string() + ": " + name,
                "is it a file of this program? Texts must have a fixed length");
  const std::vector<hsize_t> rows = shape(dataset.id());
  if (rows.size() > 1) fail(name, "has " + std::to_string(rows.size()) + " dimensions, not 1");
  const Handle space(check(H5Dget_space(dataset.id()), "read the shape of " + name), H5Sclose);
  if (H5Sget_simple_extent_type(space.id()) == H5S_NULL) return {};
  check_stored(dataset.id(), name);
  const std::size_t width = H5Tget_size(type.id());
  std::vector<char> padded(width * (rows.empty() ? 1 : rows[0]));
  if (!padded.empty())
    check(H5Dread(dataset.id(), type.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, padded.data()), "read " + name);
  std::vector<std::string> texts;
  for (std::size_t begin = 0; begin < padded.size(); begin += width)
    texts.emplace_back(&padded[begin], strnlen(&padded[begin], width));
  return texts;
}

void File::read_all(const std::string& name, hid_t type, const std::vector<hsize_t>& wanted, void* data) const {
  const Handle dataset = open_dataset(name);
  const std::vector<hsize_t> found = shape(dataset.id());
  if (found != wanted) fail(name, "is " + shape_text(found) + ", not " + shape_text(wanted));
  check_type(dataset.id(), type, name);
  if (std::find(wanted.begin(), wanted.end(), hsize_t{0}) != wanted.end()) return;
  check_stored(dataset.id(), name);
  check(H5Dread(dataset.id(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data), "read " + name);
}

void File::write_rows(hid_t dataset, hid_t type, hsize_t first, hsize_t count, const void* data) const {
  if (count == 0) return;
  std::vector<hsize_t> extent = shape(dataset);
  if (extent[0] < first + count) {
    extent[0] = first + count;
    check(H5Dset_extent(dataset, extent.data()), "grow");
  }
  const Rows rows = select_rows(dataset, extent, first, count);
  check(H5Dwrite(dataset, type, rows.memory.id(), rows.file.id(), H5P_DEFAULT, data), "write");
}

void File::read_rows(hid_t dataset, hid_t type, const std::vector<hsize_t>& row_shape, hsize_t first, hsize_t count,
                     void* data) const {
  if (count == 0) return;
  const std::vector<hsize_t> extent = shape(dataset);
  if (extent.empty() || !std::equal(extent.begin() + 1, extent.end(), row_shape.begin(), row_shape.end()))
    fail(name_of(dataset), "is " + shape_text(extent) + ", not rows of " + shape_text(row_shape));
  check_type(dataset, type, name_of(dataset));
  if (extent[0] < count || first > extent[0] - count)
    fail(name_of(dataset), "has " + std::to_string(extent[0]) + " rows, and rows " + std::to_string(first) + " to " +
                               std::to_string(first + count - 1) + " are asked for");
  const Rows rows = select_rows(dataset, extent, first, count);
  check(H5Dread(dataset, type, rows.memory.id(), rows.file.id(), H5P_DEFAULT, data), "read");
}

}  // namespace selvedge::h5
