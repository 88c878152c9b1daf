#include <catch2/catch.hpp>

#include "collision/geometry/error.hpp"
#include "pipeline/hdf5/neighbour_scale_hdf5.hpp"
#include "tests/pipeline/files.hpp"
#include "tests/source_root.hpp"

namespace selvedge::test_neighbour_scale_hdf5 {

TEST_CASE("scales by neighbours: a file gives back what was written, and the one that ships can be read",
          "[repulsion]") {
  const fake::Folder folder("neighbour_scale");
  const std::filesystem::path file = folder.path / "scales.h5";
  NeighbourScale scale = make_neighbour_scale({5, 0.002, 0.03, ScaleRange::at_least_zero}, 9);
  write_neighbour_scale(file, scale);
  const NeighbourScale read = read_neighbour_scale(file);
  CHECK(read.shape.width == 5);
  CHECK(read.shape.unit == 0.002);
  CHECK(read.shape.edge_unit == 0.03);
  CHECK(read.shape.range == ScaleRange::at_least_zero);
  CHECK(parameters_of(read.first) == parameters_of(scale.first));
  CHECK(parameters_of(read.second) == parameters_of(scale.second));
  CHECK(parameters_of(read.end) == parameters_of(scale.end));
  scale.shape.width = 6;  // not that of the networks
  write_neighbour_scale(file, scale);
  CHECK_THROWS_AS(read_neighbour_scale(file), Error);
  CHECK_THROWS_AS(read_neighbour_scale(folder.path / "none.h5"), Error);
  CHECK(read_neighbour_scale(source_root() / "configs" / "weights" / "refu.h5").shape.range ==
        ScaleRange::at_least_one);
}

}  // namespace selvedge::test_neighbour_scale_hdf5
