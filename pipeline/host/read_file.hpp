#pragma once

#include <filesystem>
#include <string>

namespace selvedge {

// The whole content of a file. `noun` is what it should be, in the errors: "mesh", "BVH". Throws what
// require_file does, and Error where it is larger than bounds.hpp allows or cannot be opened.
std::string read_file(const std::filesystem::path&, const std::string& noun);

// The same of a file that begins as text and may go on with binary data: without the byte order mark of UTF-8 that some
// editors put there. Throws Error for one of UTF-16 or UTF-32.
std::string read_headed_file(const std::filesystem::path&, const std::string& noun);

// The same of a file that is all text. A carriage return that ends a line alone, as in files of old Macs, becomes a
// line feed; one before a line feed stays.
std::string read_text_file(const std::filesystem::path&, const std::string& noun);

// The file that another file names, with symbolic links resolved. A file from elsewhere may name files below its own
// `folder` and no others. Throws Error, naming the refused path, for an absolute path, for one that leads
// out, and for what is a folder, a pipe or a device.
std::filesystem::path path_below(const std::filesystem::path& folder, const std::string& named,
                                 const std::string& where);

}  // namespace selvedge
