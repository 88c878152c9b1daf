#include "pipeline/training/training_checkpoint_hdf5.hpp"

#include <algorithm>
#include <set>
#include <sstream>

#include <fmt/format.h>

#include "collision/geometry/counted.hpp"
#include "collision/geometry/error.hpp"
#include "pipeline/hdf5/hdf5_fields.hpp"
#include "pipeline/host/write_file.hpp"
#include "pipeline/processes/together.hpp"
#include "pipeline/run/resume.hpp"
#include "pipeline/training/own_states_hdf5.hpp"

namespace selvedge {
namespace {

const h5::FileForm checkpoint_form{"selvedge training checkpoint 2", "training checkpoint", "docs/training.md"};
const h5::FileForm part_form{"selvedge training checkpoint part 1", "part of a checkpoint", "docs/training.md"};

using FieldsOut = h5::SummedFieldsOut;
using FieldsIn = TrainingFieldsIn;

std::vector<float> all_weights(const Architecture& architecture, NetworkWeights weights) {
  std::vector<float> all;
  for (const WeightArray& array : weight_arrays(architecture, weights))
    all.insert(all.end(), array.data, array.data + static_cast<std::ptrdiff_t>(array.rows) * array.columns);
  return all;
}

void set_weights(const FieldsIn& in, const Architecture& architecture, const std::vector<float>& all,
                 NetworkWeights& weights) {
  std::size_t at = 0;
  for (const WeightArray& array : weight_arrays(architecture, weights)) {
    const auto count = static_cast<std::size_t>(array.rows) * static_cast<std::size_t>(array.columns);
    if (count > all.size() - at) in.fail("has too few weights");
    std::copy_n(all.begin() + static_cast<std::ptrdiff_t>(at), count, array.data);
    at += count;
  }
  if (at != all.size()) in.fail("has too many weights");
}

void write_adam(FieldsOut& out, const Trainer& trainer) {
  std::string names;
  std::vector<double> sizes;
  std::vector<float> values;
  for (const NamedFloats& array : adam_arrays(trainer.architecture, trainer.adam)) {
    names += array.name + "\n";
    sizes.push_back(static_cast<double>(array.values.size()));
    values.insert(values.end(), array.values.begin(), array.values.end());
  }
  out.text("adam_names", names);
  out.numbers("adam_sizes", sizes);
  out.floats("adam_values", values);
}

AdamState read_adam(FieldsIn& in, const Architecture& architecture) {
  const std::string names = in.text("adam_names");
  const std::vector<double> sizes = in.numbers("adam_sizes");
  const std::vector<float> values = in.floats("adam_values");
  std::vector<NamedFloats> arrays;
  std::size_t at = 0, begin = 0;
  for (const double size : sizes) {
    const std::size_t end = names.find('\n', begin),
                      count = static_cast<std::size_t>(in.whole("adam_sizes", size, 1e12));
    if (end == std::string::npos || count > values.size() - at) in.fail("has a damaged state of the optimiser");
    arrays.push_back(
        {names.substr(begin, end - begin),
         {values.begin() + static_cast<std::ptrdiff_t>(at), values.begin() + static_cast<std::ptrdiff_t>(at + count)}});
    begin = end + 1;
    at += count;
  }
  return adam_from_arrays(architecture, arrays, in.file.path().string());
}

void write_counts(FieldsOut& out, const Trainer& trainer) {
  const TrainingCounts& c = trainer.counts;
  out.numbers("counts", {double(c.step), double(c.rolls), double(c.frames), double(c.lost), double(c.given_up),
                         double(c.bad), double(c.bad_in_a_row), double(c.again)});
  out.text("random", fmt::format("{:016x}", trainer.random.state));
}

void write_history(FieldsOut& out, const TrainingHistory& history) {
  out.text("steps", history.steps);
  out.text("measures", history.measures);
  out.numbers("history", {history.seconds, history.best_score, double(history.best_step)});
}

void read_counts(FieldsIn& in, Trainer& trainer) {
  const std::vector<double> c = in.numbers("counts");
  if (c.size() != 8) in.fail("the field `counts` has another length");
  const auto count = [&](std::size_t k) { return in.whole("counts", c[k], 1e15); };
  trainer.counts = {count(0), static_cast<std::uint64_t>(count(1)), count(2), count(3), count(4), count(5), count(6),
                    count(7)};
  trainer.random.state = std::strtoull(in.text("random").c_str(), nullptr, 16);
}

void read_history(FieldsIn& in, TrainingHistory& history) {
  history.steps = in.text("steps");
  history.measures = in.text("measures");
  const std::vector<double> h = in.numbers("history");
  if (h.size() != 3) in.fail("the field `history` has another length");
  history.seconds = h[0];
  history.best_score = h[1];
  history.best_step = in.whole("history", h[2], 1e15);
}

// The device is left out, because a run may continue with another.
std::string configuration(TrainingOptions options) {
  options.device = {};
  return training_yaml(options);
}

void check_configuration(FieldsIn& in, const TrainingOptions& options) {
  if (in.text("config") != configuration(options))
    throw Error("the checkpoint was made under another configuration", in.file.path().string(),
                "resume with the same file and --set, or begin anew without --resume");
}

// One line per file, after that of the world.
std::string inputs_text(const RunInputs& inputs) {
  std::string text = fmt::format("{:016x}\n", inputs.scene);
  for (const InputFile& file : inputs.files) text += fmt::format("{:016x} {}\n", file.hash, file.name);
  return text;
}

RunInputs inputs_of(const std::string& text) {
  RunInputs inputs;
  std::istringstream lines(text);
  std::string line;
  if (std::getline(lines, line)) inputs.scene = std::strtoull(line.c_str(), nullptr, 16);
  while (std::getline(lines, line))
    if (line.size() > 17) inputs.files.push_back({line.substr(17), std::strtoull(line.c_str(), nullptr, 16)});
  return inputs;
}

// Makes names of files relative to the training file absolute, because the folder may have moved.
std::vector<InputFile> located(std::vector<InputFile> files, const std::filesystem::path& folder) {
  for (InputFile& file : files) file.name = (folder / file.name).lexically_normal().string();
  return files;
}

// The inputs at the start of the run.
RunInputs checked_inputs(FieldsIn& in, const TrainingOptions& options) {
  RunInputs before = inputs_of(in.text("inputs"));
  const std::filesystem::path& folder = options.samples.folder;
  check_input_files(in.file.path(), located(before.files, folder),
                    located(files_of(options.samples.people, folder), folder), "the training file");
  return before;
}

void check_world(const FieldsIn& in, const RunInputs& before, const RunInputs& now) {
  if (before.scene != now.scene)
    throw Error("was made with other bodies, garments or clips, though no file has changed",
                in.file.path().string() + ": inputs",
                "go on with the version of the program that began the run, or begin anew without --resume");
}

// Where several processes train, what is each one's own lies beside the checkpoint in parts, which are named by rank
// and checksum. The checkpoint lists the checksums: it fits its parts alone, and those of the one before it stay until
// it is in its place.
using Parts = std::vector<std::uint64_t>;  // checksums by rank

std::filesystem::path part_path(const std::filesystem::path& checkpoint, std::size_t rank, std::uint64_t sum) {
  return checkpoint.parent_path() / fmt::format("{}.rank{}.{:016x}.h5", checkpoint.stem().string(), rank, sum);
}

// Returns its checksum.
std::uint64_t write_part(const std::filesystem::path& checkpoint, const Trainer& trainer) {
  const auto rank = static_cast<std::size_t>(rank_of(trainer));
  const std::filesystem::path fresh = part_path(checkpoint, rank, 0);
  std::uint64_t sum = 0;
  h5::write_form(fresh, part_form, [&](const h5::File& file) {
    FieldsOut out{{file}};
    out.numbers("rank", {double(rank)});
    write_counts(out, trainer);
    write_own_states(out, trainer);
    out.write_checksum();
    sum = out.sum;
  });
  rename_file(fresh, part_path(checkpoint, rank, sum));
  return sum;
}

void read_part(const std::filesystem::path& checkpoint, const Parts& parts, Trainer& trainer) {
  const auto rank = static_cast<std::size_t>(rank_of(trainer));
  const std::filesystem::path path = part_path(checkpoint, rank, parts[rank]);
  if (!std::filesystem::exists(path))
    throw Error("a part of the checkpoint is missing", path.string(),
                "give all processes one folder, or begin the training anew, without --resume");
  const h5::Fields form(path, part_form);  // checks the form
  const h5::File file = h5::File::open(path);
  FieldsIn in(file);
  if (in.numbers("rank") != std::vector<double>{double(rank)}) in.fail("is the part of another process");
  read_counts(in, trainer);
  read_own_states(in, trainer);
  in.check_checksum();
  if (in.sum != parts[rank]) in.fail("is of another checkpoint than the one beside it");
}

std::string parts_text(const Parts& parts) {
  std::string text;
  for (const std::uint64_t sum : parts) text += fmt::format("{:016x}\n", sum);
  return text;
}

// None: the checkpoint is of one process.
Parts read_parts(const h5::File& file) {
  Parts parts;
  if (!file.has("parts")) return parts;
  std::istringstream lines(file.read_text("parts"));
  for (std::string line; std::getline(lines, line) && line.size() == 16;)
    parts.push_back(std::strtoull(line.c_str(), nullptr, 16));
  return parts;
}

// Removes parts that no checkpoint lists any more.
void remove_other_parts(const std::filesystem::path& checkpoint, const Parts& parts) {
  std::set<std::filesystem::path> kept, found;
  for (std::size_t rank = 0; rank < parts.size(); ++rank) kept.insert(part_path(checkpoint, rank, parts[rank]));
  const std::string begin = checkpoint.stem().string() + ".rank";
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(checkpoint.parent_path(), ignored))
    if (entry.path().filename().string().starts_with(begin)) found.insert(entry.path());
  for (const std::filesystem::path& path : found)
    if (!kept.contains(path)) remove_file(path);
}

void check_process_count(const std::filesystem::path& path, const Parts& parts, const Processes* processes) {
  const std::size_t then = std::max<std::size_t>(parts.size(), 1),
                    now = processes ? std::size_t(processes->count()) : 1;
  if (then == now) return;
  const std::string again = then == 1 ? "without mpirun" : fmt::format("with `mpirun -n {}`", then);
  throw Error(
      fmt::format("the checkpoint is of {}, and {} now: each has states of its own, and the samples of a step "
                  "would be others",
                  counted(int(then), "process", "processes"), counted(int(now), "trains", "train")),
      path.string(),
      "go on " + again + ", or begin anew, without --resume; `weights` of another run takes weights.h5 of this one");
}

void write_checkpoint(const std::filesystem::path& path, const Trainer& trainer, const TrainingHistory& history,
                      const Parts& parts) {
  h5::write_form(path, checkpoint_form, [&](const h5::File& file) {
    FieldsOut out{{file}};
    out.text("config", configuration(trainer.options));
    out.text("inputs", inputs_text(trainer.inputs));
    out.text("trained_on", trained_on_json(trainer.trained_on));
    write_counts(out, trainer);
    write_history(out, history);
    out.floats("weights", all_weights(trainer.architecture, trainer.network.weights));
    const auto write_sums = [&](const std::string& name, const DoubleAccumulators& sums) {
      std::vector<double> values{sums.rows, sums.updates};
      values.insert(values.end(), sums.sum.begin(), sums.sum.end());
      values.insert(values.end(), sums.sum_squared.begin(), sums.sum_squared.end());
      out.numbers("sums_" + name, values);
    };
    visit_statistics(write_sums, trainer.sums);
    write_adam(out, trainer);
    if (parts.empty())
      write_own_states(out, trainer);
    else
      out.text("parts", parts_text(parts));
    out.write_checksum();
  });
}

}  // namespace

void write_training_checkpoint(const std::filesystem::path& path, const Trainer& trainer,
                               const TrainingHistory& history) {
  Parts parts;
  if (trainer.processes) parts = gathered(*trainer.processes, write_part(path, trainer));
  if (rank_of(trainer) == 0) write_checkpoint(path, trainer, history, parts);
  if (trainer.processes) wait_for_all(*trainer.processes);
  if (rank_of(trainer) == 0) remove_other_parts(path, parts);
}

std::unique_ptr<Trainer> read_training_checkpoint(const std::filesystem::path& path, const TrainingOptions& options,
                                                  TrainingHistory& history, Processes* processes) {
  if (!std::filesystem::exists(path))
    throw Error("there is nothing to resume: no checkpoint", path.string(), "run without --resume");
  const h5::Fields form(path, checkpoint_form);  // checks the form
  const h5::File file = h5::File::open(path);
  FieldsIn in(file);
  check_configuration(in, options);
  const Parts parts = read_parts(file);
  check_process_count(path, parts, processes);
  const RunInputs before = checked_inputs(in, options);
  auto trainer = make_empty_trainer(options, processes);
  check_world(in, before, trainer->inputs);
  trainer->trained_on = read_trained_on(in.text("trained_on"), path.string() + ": trained_on");
  read_counts(in, *trainer);
  read_history(in, history);
  NetworkWeights weights = blank_weights(trainer->architecture);
  set_weights(in, trainer->architecture, in.floats("weights"), weights);
  const auto read_sums = [&](const std::string& name, DoubleAccumulators& sums) {
    const std::vector<double> values = in.numbers("sums_" + name);
    const auto columns = static_cast<std::ptrdiff_t>(sums.sum.size());
    if (values.size() != 2 + 2 * sums.sum.size()) in.fail("sums of " + name + " have another length");
    sums.rows = values[0];
    sums.updates = values[1];
    std::copy_n(values.begin() + 2, columns, sums.sum.begin());
    std::copy_n(values.begin() + 2 + columns, columns, sums.sum_squared.begin());
  };
  visit_statistics(read_sums, trainer->sums);
  trainer->adam = read_adam(in, trainer->architecture);
  trainer->network = make_training_network(trainer->architecture, std::move(weights));
  if (parts.empty())
    read_own_states(in, *trainer);
  else
    in.text("parts");
  in.check_checksum();
  if (!parts.empty()) read_part(path, parts, *trainer);
  trainer->torch = torch_network_for(options.device, trainer->architecture, trainer->network.weights);
  return trainer;
}

}  // namespace selvedge
