#include "pipeline/host/bounds.hpp"

#include <fmt/format.h>

#include "collision/geometry/error.hpp"

namespace selvedge {

void refuse_too_many(double count, std::int64_t most, const std::string& noun, const std::string& where,
                     const std::string& cure) {
  if (!(count <= static_cast<double>(most)))
    throw Error(fmt::format("asks for {:.4g} {}; {} are the most", count, noun, most), where, cure);
}

}  // namespace selvedge
