#include "pipeline/formats/npz.hpp"

#include <fmt/format.h>
#include <zip.h>

#include "collision/geometry/error.hpp"
#include "collision/geometry/require_file.hpp"
#include "pipeline/host/bounds.hpp"

namespace selvedge {
namespace {

constexpr std::string_view extension = ".npy";

std::string damaged_cure() { return "the file is damaged or incomplete; copy or download it again"; }

// The size that the archive claims for an entry, if its compressed bytes can give as much.
std::size_t plausible_size(const zip_stat_t& entry, std::uintmax_t file_size, const NpyPlace& place) {
  constexpr std::uint64_t most_by_byte = 1032;  // most bytes that deflate packs into one
  if (entry.encryption_method != ZIP_EM_NONE)
    throw Error("is encrypted", place.text(), "save the arrays with numpy.savez");
  if (entry.comp_method != ZIP_CM_STORE && entry.comp_method != ZIP_CM_DEFLATE)
    throw Error(fmt::format("is compressed by method {}", entry.comp_method), place.text(),
                "save the arrays with numpy.savez or numpy.savez_compressed");
  if (entry.comp_size > file_size || entry.size / most_by_byte > entry.comp_size)
    throw Error(fmt::format("claims {} bytes of {} compressed ones", entry.size, entry.comp_size), place.text(),
                damaged_cure());
  refuse_too_many(static_cast<double>(entry.size), most_numbers, "bytes", place.text(), "save less in one array");
  return entry.size;
}

}  // namespace

struct Npz::Archive {
  std::unique_ptr<zip_t, void (*)(zip_t*)> zip{nullptr, zip_discard};
  std::uintmax_t file_size = 0;
};

Npz::Npz(const std::filesystem::path& path) : path_(path), archive_(std::make_unique<Archive>()) {
  require_file(path, ".npz");
  std::error_code problem;
  archive_->file_size = std::filesystem::file_size(path, problem);
  if (problem) throw Error("cannot be opened (" + problem.message() + ")", path.string(), "check the path");
  int code = 0;
  archive_->zip.reset(zip_open(path.c_str(), ZIP_RDONLY, &code));
  if (archive_->zip) return;
  zip_error_t error;
  zip_error_init_with_code(&error, code);
  const std::string reason = zip_error_strerror(&error);
  zip_error_fini(&error);
  throw Error("cannot be opened as an .npz archive (" + reason + ")", path.string(),
              "is it an .npz file, and whole? A .pkl or .npy file must be saved as .npz first, with numpy.savez");
}

Npz::Npz(Npz&&) noexcept = default;
Npz::~Npz() = default;

bool Npz::has(const std::string& name) const {
  return zip_name_locate(archive_->zip.get(), (name + std::string(extension)).c_str(), 0) >= 0;
}

std::vector<std::string> Npz::names() const {
  std::vector<std::string> names;
  const zip_int64_t count = zip_get_num_entries(archive_->zip.get(), 0);
  for (zip_int64_t i = 0; i < count; ++i) {
    const char* raw = zip_get_name(archive_->zip.get(), static_cast<zip_uint64_t>(i), 0);
    const std::string_view name = raw ? raw : "";
    if (name.ends_with(extension)) names.emplace_back(name.substr(0, name.size() - extension.size()));
  }
  return names;
}

NpyPlace Npz::place(const std::string& name) const { return {path_.string(), name}; }

std::string Npz::bytes(const std::string& name) const {
  const NpyPlace at = place(name);
  zip_t* const zip = archive_->zip.get();
  const zip_int64_t index = zip_name_locate(zip, (name + std::string(extension)).c_str(), 0);
  if (index < 0) throw Error("is missing", at.text(), fmt::format("the file has: {}", fmt::join(names(), ", ")));
  zip_stat_t entry;
  zip_stat_init(&entry);
  if (zip_stat_index(zip, static_cast<zip_uint64_t>(index), 0, &entry) != 0)
    throw Error("cannot be found in the archive", at.text(), damaged_cure());
  const std::size_t size = plausible_size(entry, archive_->file_size, at);
  const std::unique_ptr<zip_file_t, int (*)(zip_file_t*)> file(
      zip_fopen_index(zip, static_cast<zip_uint64_t>(index), 0), zip_fclose);
  if (!file) throw Error(fmt::format("cannot be read ({})", zip_strerror(zip)), at.text(), damaged_cure());
  std::string bytes(size, '\0');
  char beyond = 0;
  std::size_t done = 0;
  zip_int64_t got = 0;
  while (done < size && (got = zip_fread(file.get(), bytes.data() + done, size - done)) > 0)
    done += static_cast<std::size_t>(got);
  // libzip compares the checksum only when reading beyond the end.
  if (got >= 0) got = zip_fread(file.get(), &beyond, 1);
  if (got != 0 || done != size)
    throw Error(got < 0 ? fmt::format("cannot be read ({})", zip_file_strerror(file.get()))
                        : fmt::format("has {} bytes, the archive says {}", done + static_cast<std::size_t>(got), size),
                at.text(), damaged_cure());
  return bytes;
}

NpyArray<double> Npz::numbers(const std::string& name) const { return npy_numbers(bytes(name), place(name)); }

NpyArray<std::int64_t> Npz::integers(const std::string& name) const { return npy_integers(bytes(name), place(name)); }

NpyArray<std::string> Npz::texts(const std::string& name) const { return npy_texts(bytes(name), place(name)); }

}  // namespace selvedge
