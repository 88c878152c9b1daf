#include "pipeline/drapes/stage_file_hdf5.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "pipeline/hdf5/plain_network_hdf5.hpp"

namespace selvedge {
namespace {

constexpr double most_steps = 1e15;
const h5::FileForm stage_form{"selvedge drape training 1", "stage of a training", "docs/repulsion.md"};

}  // namespace

const StagePart* StageFile::find(const std::string& name) const {
  const auto at = std::ranges::find(parts, name, &StagePart::name);
  return at == parts.end() ? nullptr : &*at;
}

void write_stage_file(const std::filesystem::path& path, const StageFile& stage) {
  h5::write_form(path, stage_form, [&](const h5::File& file) {
    file.write_text("config", stage.config + ".");  // never empty
    file.write_text("random", fmt::format("{}", stage.random));
    file.write_text("csv", stage.csv + ".");
    h5::write_numbers(file, "progress", {static_cast<double>(stage.step), stage.seconds});
    std::vector<std::string> names;
    for (const StagePart& part : stage.parts) {
      names.push_back(part.name);
      const h5::Handle group = file.make_group(part.name);
      write_plain_network(file, part.name + "/network", part.network);
      write_plain_adam(file, part.name + "/adam", part.adam);
    }
    file.write_texts("parts", names);
    std::vector<std::string> further;
    const h5::Handle group = file.make_group("numbers");
    for (const auto& [name, values] : stage.numbers) {
      further.push_back(name);
      h5::write_numbers(file, "numbers/" + name, values);
    }
    if (!further.empty()) file.write_texts("number_names", further);
  });
}

StageFile read_stage_file(const std::filesystem::path& path) {
  const h5::Fields fields(path, stage_form);
  StageFile stage;
  const auto text = [&](const std::string& name) {
    std::string value = fields.text(name);
    if (value.empty()) fields.fail(name, "is empty");
    value.pop_back();
    return value;
  };
  stage.config = text("config");
  stage.csv = text("csv");
  try {
    stage.random = std::stoull(fields.text("random"));
  } catch (const std::logic_error&) {
    fields.fail("random", "is no number");
  }
  const std::vector<double> progress = fields.numbers("progress");
  if (progress.size() != 2 || !(progress[0] >= 0 && progress[0] <= most_steps))
    fields.fail("progress", "is not a step and a time");
  stage.step = static_cast<long>(progress[0]);
  stage.seconds = progress[1];
  for (const std::string& name : fields.texts("parts")) {
    StagePart part{name, read_plain_network(fields, name + "/network"), {}};
    part.adam = read_plain_adam(fields, name + "/adam", parameter_count(part.network));
    stage.parts.push_back(std::move(part));
  }
  if (fields.has("number_names"))
    for (const std::string& name : fields.texts("number_names"))
      stage.numbers[name] = fields.numbers("numbers/" + name);
  return stage;
}

}  // namespace selvedge
