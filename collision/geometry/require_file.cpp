#include "collision/geometry/require_file.hpp"

#include "collision/geometry/error.hpp"

namespace selvedge {

void require_file(const std::filesystem::path& path, const std::string& noun) {
  using std::filesystem::file_type;
  std::error_code ignored;
  const file_type type = std::filesystem::status(path, ignored).type();
  if (type == file_type::directory) throw Error("is a folder", path.string(), "name the " + noun + " file in it");
  for (const auto& [other, name] :
       {std::pair(file_type::fifo, "a pipe"), std::pair(file_type::socket, "a socket"),
        std::pair(file_type::character, "a device"), std::pair(file_type::block, "a device")})
    if (type == other)
      throw Error(std::string("is ") + name + ", which might never end", path.string(),
                  "write what it gives into a file, and name the " + noun + " file");
}

}  // namespace selvedge
