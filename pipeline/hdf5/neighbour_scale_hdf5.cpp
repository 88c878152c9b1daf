#include "pipeline/hdf5/neighbour_scale_hdf5.hpp"

#include "pipeline/hdf5/plain_network_hdf5.hpp"

namespace selvedge {
namespace {

const h5::FileForm scale_form{"selvedge scales 1", "scales of the repulsive layer", "docs/repulsion.md"};

bool fits(const NeighbourScale& made, const NeighbourScale& read) {
  return made.first.inputs() == read.first.inputs() && made.first.outputs() == read.first.outputs() &&
         made.second.inputs() == read.second.inputs() && made.second.outputs() == read.second.outputs() &&
         made.end.inputs() == read.end.inputs() && made.end.outputs() == read.end.outputs();
}

}  // namespace

void write_neighbour_scale(const std::filesystem::path& path, const NeighbourScale& scale) {
  h5::write_form(path, scale_form, [&](const h5::File& file) {
    const bool least_one = scale.shape.range == ScaleRange::at_least_one;
    h5::write_integers(file, "form", {scale.shape.width, least_one ? 1 : 0});
    h5::write_numbers(file, "units", {scale.shape.unit, scale.shape.edge_unit});
    write_plain_network(file, "first", scale.first);
    write_plain_network(file, "second", scale.second);
    write_plain_network(file, "end", scale.end);
  });
}

NeighbourScale read_neighbour_scale(const std::filesystem::path& path) {
  const h5::Fields fields(path, scale_form);
  const std::vector<int> form = fields.integers("form");
  const std::vector<double> units = fields.numbers("units");
  constexpr int widest = 4096;
  if (form.size() != 2 || form[0] < 1 || form[0] > widest || form[1] < 0 || form[1] > 1)
    fields.fail("form", "is not a width, and a range of 0 or 1");
  if (units.size() != 2 || !(units[0] > 0) || !(units[1] > 0)) fields.fail("units", "are not two lengths above 0");
  NeighbourScale scale;
  scale.shape = {form[0], units[0], units[1], form[1] == 1 ? ScaleRange::at_least_one : ScaleRange::at_least_zero};
  scale.first = read_plain_network(fields, "first");
  scale.second = read_plain_network(fields, "second");
  scale.end = read_plain_network(fields, "end");
  if (!fits(make_neighbour_scale(scale.shape, 1), scale)) fields.fail("form", "does not fit the networks");
  return scale;
}

}  // namespace selvedge
