#include "pipeline/host/cure_to_write.hpp"

#include <cerrno>
#include <system_error>

#include "collision/geometry/path_beside.hpp"

namespace selvedge {

std::string cure_to_write(const std::string& reason) {
  const auto is = [&](int number) { return reason == std::generic_category().message(number); };
  if (is(EFBIG))
    return "files may not become that large here: raise the limit of the shell (`ulimit -f`), or choose a disk whose "
           "file system takes larger ones";
  if (is(ENOSPC) || is(EDQUOT)) return "free some space, or choose another folder";
  if (is(ENOTDIR) || is(EEXIST)) return "a file is where a folder would be: give another name, or move it away";
  if (is(EISDIR)) return "a folder has this name: name a file, in it for example";
  if (is(ENAMETOOLONG)) return "choose a shorter name or path";
  return write_cure;
}

}  // namespace selvedge
