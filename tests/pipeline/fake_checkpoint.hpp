#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace selvedge::fake {

// One tensor of a checkpoint. Its numbers have the last index fastest.
struct CheckpointTensor {
  std::string name;
  std::vector<std::int64_t> shape;
  std::vector<float> numbers;
};

std::vector<std::string> published_kinds();  // hood, hood_cvpr, fine15, fine48, contourcraft

// Tensors of a published checkpoint without numbers, in the order of its state dictionary. Published ones have the
// width 128.
std::vector<CheckpointTensor> published_shapes(const std::string& kind, int width);

// The same with numbers: by the formula of the parity pack with SEED `seed`, and sums of statistics that give column c
// the mean c + 1 and the deviation 2.
std::vector<CheckpointTensor> published_tensors(const std::string& kind, int width, std::uint64_t seed);

// Number k of the parity pack's formula, in [-1, 1).
float formula_number(std::uint64_t seed, std::uint64_t k);

// Writes a pickle of protocol 2, opcode by opcode. It remembers texts and globals as Python does.
class PickleText {
 public:
  std::string bytes = "\x80\x02";

  PickleText& raw(const std::string& opcodes) { return bytes += opcodes, *this; }
  PickleText& text(const std::string&);
  PickleText& integer(std::int64_t);
  PickleText& number(double);
  PickleText& global(const std::string& module, const std::string& name);
  PickleText& ordered_dict() { return global("collections", "OrderedDict").raw(")R"); }
  PickleText& storage(const std::string& key, std::int64_t count);
  PickleText& tensor(const std::string& key, std::int64_t count, std::int64_t offset,
                     const std::vector<std::int64_t>& shape, const std::vector<std::int64_t>& stride);
  std::string finished() const { return bytes + "."; }

 private:
  PickleText& tuple(const std::vector<std::int64_t>&);
  PickleText& remembered(const std::string& key, const std::string& opcodes);
  std::map<std::string, int> memo_;
};

using Entries = std::vector<std::pair<std::string, std::string>>;  // names and contents, in the order of the file

// A ZIP archive of stored entries with correct checksums. `wide` adds the ZIP64 records that torch always writes.
std::string stored_zip(const Entries&, bool wide = true);

// Parts of a checkpoint beside the weights.
struct CheckpointExtras {
  bool settings = true;         // config, optimizer and scheduler, as the authors' save function writes them
  bool material_stack = false;  // as in fine-tuned files
};

// Entries of a checkpoint as torch.save writes it under the name `stem`.
Entries checkpoint_entries(const std::vector<CheckpointTensor>&, const CheckpointExtras& = {},
                           const std::string& stem = "step_0000056000");

// The same as a file.
std::filesystem::path write_checkpoint(const std::filesystem::path&, const std::vector<CheckpointTensor>&,
                                       const CheckpointExtras& = {});

}  // namespace selvedge::fake
