#include "pipeline/formats/zip_archive.hpp"

#include <fmt/format.h>
#include <zip.h>

#include <algorithm>

#include "collision/geometry/error.hpp"
#include "collision/geometry/require_file.hpp"
#include "pipeline/host/bounds.hpp"

namespace selvedge {
namespace {

constexpr std::size_t most_entries = 100'000;

std::string damaged_cure() { return "the file is damaged or incomplete; copy or download it again"; }

// The size that the archive claims for an entry, if its compressed bytes can give as much.
std::size_t plausible_size(const zip_stat_t& entry, std::uintmax_t file_size, const ZipForm& form,
                           const std::string& where) {
  constexpr std::uint64_t most_by_byte = 1032;  // most bytes that deflate packs into one
  if (entry.encryption_method != ZIP_EM_NONE) throw Error("is encrypted", where, form.how_made);
  const bool stored = entry.comp_method == ZIP_CM_STORE;
  if (!stored && !(form.compressed && entry.comp_method == ZIP_CM_DEFLATE))
    throw Error(fmt::format("is compressed by method {}", entry.comp_method), where, form.how_made);
  if (entry.comp_size > file_size ||
      (stored ? entry.size != entry.comp_size : entry.size / most_by_byte > entry.comp_size))
    throw Error(fmt::format("claims {} bytes of {} packed ones", entry.size, entry.comp_size), where, damaged_cure());
  refuse_too_many(static_cast<double>(entry.size), form.most, "bytes", where, "save less in one entry");
  return entry.size;
}

}  // namespace

struct ZipArchive::Opened {
  std::unique_ptr<zip_t, void (*)(zip_t*)> zip{nullptr, zip_discard};
  std::uintmax_t file_size = 0;
};

ZipArchive::ZipArchive(const std::filesystem::path& path, const ZipForm& form)
    : form_(form), opened_(std::make_unique<Opened>()) {
  require_file(path, form.noun);
  std::error_code problem;
  opened_->file_size = std::filesystem::file_size(path, problem);
  if (problem) throw Error("cannot be opened (" + problem.message() + ")", path.string(), "check the path");
  int code = 0;
  zip_t* const zip = zip_open(path.c_str(), ZIP_RDONLY | (form.consistent ? ZIP_CHECKCONS : 0), &code);
  opened_->zip.reset(zip);
  if (!zip && form.consistent && code == ZIP_ER_INCONS)
    throw Error("has a directory and entries that contradict each other", path.string(), damaged_cure());
  if (!zip) {
    zip_error_t error;
    zip_error_init_with_code(&error, code);
    const std::string reason = zip_error_strerror(&error);
    zip_error_fini(&error);
    throw Error("cannot be opened as an archive (" + reason + ")", path.string(), form.if_none);
  }
  const auto count = static_cast<std::size_t>(zip_get_num_entries(zip, 0));
  refuse_too_many(static_cast<double>(count), most_entries, "entries", path.string(), damaged_cure());
  for (std::size_t i = 0; i < count; ++i) {
    const char* const name = zip_get_name(zip, i, 0);
    names_.emplace_back(name ? name : "");
  }
  std::vector<std::string> sorted = names_;
  std::ranges::sort(sorted);
  if (std::ranges::adjacent_find(sorted) != sorted.end())
    throw Error("has two entries of one name", path.string(), damaged_cure());
}

ZipArchive::ZipArchive(ZipArchive&&) noexcept = default;
ZipArchive::~ZipArchive() = default;

bool ZipArchive::has(const std::string& name) const {
  return zip_name_locate(opened_->zip.get(), name.c_str(), 0) >= 0;
}

std::string ZipArchive::bytes(const std::string& name, const std::string& where) const {
  zip_t* const zip = opened_->zip.get();
  zip_stat_t entry;
  zip_stat_init(&entry);
  if (zip_stat(zip, name.c_str(), 0, &entry) != 0) throw Error("is missing in the archive", where, damaged_cure());
  const std::size_t size = plausible_size(entry, opened_->file_size, form_, where);
  const std::unique_ptr<zip_file_t, int (*)(zip_file_t*)> file(zip_fopen_index(zip, entry.index, 0), zip_fclose);
  if (!file) throw Error(fmt::format("cannot be read ({})", zip_strerror(zip)), where, damaged_cure());
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
                where, damaged_cure());
  return bytes;
}

}  // namespace selvedge
