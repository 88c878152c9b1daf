#pragma once

#include "pipeline/cells/cell_list.hpp"
#include "pipeline/scene/setup.hpp"

namespace selvedge {

// What cells that run scenes share.

// The scene's file, the files that its values name, and those of config_files_near.
std::vector<std::filesystem::path> needs_of(const Setup&);

// The materials and outfits that a scene in the folder finds by name, but for the program's own.
std::vector<std::filesystem::path> config_files_near(const std::filesystem::path& folder);

// A hash of the scene's configuration and of the bytes of the files that its values name, wherever they lie.
std::string inputs_key(const Setup&);

// Writes the soft tissue that a run has computed to the cache from which read_tissue reads it. A cache that cannot be
// written costs the next run time, and this one nothing: the log (or null) says why.
void keep_tissue(const Setup&, std::ostream* log);

// The scene of a cell, which its key and its run need, read once for both.
class LastSetup {
 public:
  template <class Read>
  const Setup& get(std::size_t number, const Read& read) {
    if (!setup_ || number_ != number) setup_.emplace(read());
    number_ = number;
    return *setup_;
  }

 private:
  std::size_t number_ = 0;
  std::optional<Setup> setup_;
};

}  // namespace selvedge
