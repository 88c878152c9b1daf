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
  return write_cure;
}

}  // namespace selvedge
