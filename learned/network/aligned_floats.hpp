#pragma once

#include <cstddef>
#include <cstdlib>
#include <memory>

namespace selvedge {

// Zeros that begin at a cache line. Large arrays begin at a large page, and the system is asked for such pages, so that
// scattered rows are found faster.
class AlignedFloats {
 public:
  AlignedFloats() = default;
  explicit AlignedFloats(std::size_t size);
  float* data() { return data_.get(); }
  const float* data() const { return data_.get(); }
  std::size_t size() const { return size_; }

 private:
  struct Free {
    void operator()(float* data) const { std::free(data); }
  };
  std::unique_ptr<float[], Free> data_;
  std::size_t size_ = 0;
};

}  // namespace selvedge
