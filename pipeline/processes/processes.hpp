#pragma once

#include <cstddef>
#include <span>

namespace selvedge {

// Processes that do one work together, numbered by rank from 0. All of them make the same calls in the same order; a
// call returns when every process has made it. What is passed to them is the same on every machine only if the machines
// store numbers alike.
class Processes {
 public:
  virtual ~Processes() = default;
  virtual int rank() const = 0;  // of this process
  virtual int count() const = 0;
  // Every process gives a block of one size, and gets the blocks of all by rank.
  virtual void gather(std::span<const std::byte> block, std::span<std::byte> all) = 0;
  // Every process gives a block for each rank, all of one size, and gets those that are for it by rank of the giver.
  virtual void exchange(std::span<const std::byte> blocks, std::span<std::byte> got) = 0;
};

}  // namespace selvedge
