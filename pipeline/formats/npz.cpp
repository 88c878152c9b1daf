#include "pipeline/formats/npz.hpp"

#include <fmt/format.h>

#include "collision/geometry/error.hpp"
#include "pipeline/host/bounds.hpp"

namespace selvedge {
namespace {

constexpr std::string_view extension = ".npy";

const ZipForm npz_form{
    ".npz",
    "is it an .npz file, and whole? A .pkl or .npy file must be saved as .npz first, with numpy.savez",
    "save the arrays with numpy.savez or numpy.savez_compressed",
    true,
    most_numbers,
    true};

}  // namespace

Npz::Npz(const std::filesystem::path& path) : path_(path), archive_(path, npz_form) {}

bool Npz::has(const std::string& name) const { return archive_.has(name + std::string(extension)); }

std::vector<std::string> Npz::names() const {
  std::vector<std::string> names;
  for (const std::string& name : archive_.names())
    if (name.ends_with(extension)) names.push_back(name.substr(0, name.size() - extension.size()));
  return names;
}

NpyPlace Npz::place(const std::string& name) const { return {path_.string(), name}; }

std::string Npz::bytes(const std::string& name) const {
  const std::string where = place(name).text();
  if (!has(name)) throw Error("is missing", where, fmt::format("the file has: {}", fmt::join(names(), ", ")));
  return archive_.bytes(name + std::string(extension), where);
}

NpyArray<double> Npz::numbers(const std::string& name) const { return npy_numbers(bytes(name), place(name)); }

NpyArray<std::int64_t> Npz::integers(const std::string& name) const { return npy_integers(bytes(name), place(name)); }

NpyArray<std::string> Npz::texts(const std::string& name) const { return npy_texts(bytes(name), place(name)); }

}  // namespace selvedge
