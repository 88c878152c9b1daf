#pragma once

#include <hdf5.h>

#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace selvedge::h5 {

// Owns one HDF5 identifier. Closing never throws: flush data that must not be lost before.
class Handle {
 public:
  using Close = herr_t (*)(hid_t);
  Handle() = default;
  Handle(hid_t id, Close close) : id_(id), close_(close) {}
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
  }
  ~Handle() { reset(); }
  void reset() {
    if (id_ >= 0) close_(std::exchange(id_, -1));
  }
  hid_t id() const { return id_; }

 private:
  hid_t id_ = -1;
  Close close_ = nullptr;
};

// Throws Error built from HDF5's own error stack when `result` is negative; returns it otherwise.
hid_t checked(hid_t result, const std::filesystem::path& file, const std::string& doing);

// Turns off HDF5's own printing of errors for the calling thread.
void silence();

Handle text_type(std::size_t length);  // fixed length, padded with zeros; `length` > 0

// A file and the calls on it that may fail, each turned into an Error that names the file.
class File {
 public:
  // A file that must not exist yet: take a path_beside, then rename it. `followed`: others read it while it is written.
  static File create(const std::filesystem::path&, bool followed = true);
  static File open(const std::filesystem::path&);  // SWMR read: also opens files of killed writers

  hid_t id() const { return handle_.id(); }
  const std::filesystem::path& path() const { return path_; }
  void move_to(const std::filesystem::path& path);  // renames the open file
  hid_t check(hid_t result, const std::string& doing) const { return checked(result, path_, doing); }
  void flush() const;
  void start_swmr() const;
  void close();  // throws if buffered data cannot be written
  // After a failed write: closes without touching the disk again, so that the file stays as a killed writer would leave
  // it. A plain close would mark it as complete, with a wrong end of file.
  void abandon();

  Handle make_group(const std::string& name) const;
  // A dataset of fixed size, written at once. Values are contiguous in `data`.
  void write_constant(const std::string& name, hid_t type, const std::vector<hsize_t>& shape, const void* data) const;
  void write_text(const std::string& name, const std::string& text) const;
  void write_texts(const std::string& name, const std::vector<std::string>& texts) const;
  // A dataset that grows along its first dimension, in chunks of `chunk_rows`.
  Handle make_growing(const std::string& name, hid_t type, const std::vector<hsize_t>& row_shape, hsize_t chunk_rows,
                      hsize_t first_rows = 0) const;
  Handle open_dataset(const std::string& name) const;
  bool has(const std::string& name) const;
  std::vector<hsize_t> shape(hid_t dataset) const;

  // Files may come from anyone. So readers check shapes and types before they read, and values must be stored in the
  // file itself. They throw Error with file, field and sizes for another shape, for another class of numbers (HDF5
  // would convert integers to floating point), for more values than the stored bytes can hold, for values in other
  // files, and for data that HDF5 cannot read.
  // The shape of a dataset with `rank` extents. With `growing` the first may be larger than what is stored.
  std::vector<hsize_t> shape_of(const std::string& name, std::size_t rank, bool growing = false) const;
  std::string read_text(const std::string& name) const;  // the only text, or the first one
  std::vector<std::string> read_texts(const std::string& name) const;
  // The whole dataset, which must have exactly this shape.
  void read_all(const std::string& name, hid_t type, const std::vector<hsize_t>& shape, void* data) const;

  // Rows [first, first + count) of a dataset. Writing grows it to that length; reading throws for rows of another
  // shape.
  void write_rows(hid_t dataset, hid_t type, hsize_t first, hsize_t count, const void* data) const;
  void read_rows(hid_t dataset, hid_t type, const std::vector<hsize_t>& row_shape, hsize_t first, hsize_t count,
                 void* data) const;

 private:
  File(std::filesystem::path path, Handle handle) : path_(std::move(path)), handle_(std::move(handle)) {}
  [[noreturn]] void fail(const std::string& name, const std::string& what) const;
  void check_stored(hid_t dataset, const std::string& name) const;
  void check_type(hid_t dataset, hid_t wanted, const std::string& name) const;
  std::filesystem::path path_;
  Handle handle_;
};

// Writes a file beside its place and renames it when it is whole. Where a write fails it leaves nothing.
void write_whole(const std::filesystem::path&, const std::function<void(const File&)>& fields);

}  // namespace selvedge::h5
