#include "learned/network/aligned_floats.hpp"

#if defined(__linux__)
#include <sys/mman.h>
#endif

#include <cstring>
#include <new>

namespace selvedge {

AlignedFloats::AlignedFloats(std::size_t size) : size_(size) {
  constexpr std::size_t line = 64, large_page = std::size_t{2} << 20;
  const std::size_t alignment = size * sizeof(float) >= large_page ? large_page : line;
  const std::size_t bytes = (size * sizeof(float) + alignment - 1) / alignment * alignment;
  if (bytes == 0) return;
  data_.reset(static_cast<float*>(std::aligned_alloc(alignment, bytes)));
  if (!data_) throw std::bad_alloc();
#if defined(__linux__)
  if (alignment == large_page) madvise(data_.get(), bytes, MADV_HUGEPAGE);  // a request only, which may fail
#endif
  std::memset(data_.get(), 0, bytes);
}

}  // namespace selvedge
