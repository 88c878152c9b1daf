#include "pipeline/hdf5/xdmf.hpp"

#include <fmt/format.h>

#include "pipeline/host/html_text.hpp"
#include "pipeline/host/write_file.hpp"

namespace selvedge {
namespace {

// An array of the cloth at one time, of `rows` times: vectors or numbers.
std::string attribute(const std::string& name, const std::string& h5, Eigen::Index vertices, bool vectors,
                      std::size_t row, std::size_t rows) {
  return fmt::format(
      R"(     <Attribute Name="{name}" AttributeType="{type}" Center="Node">
      <DataItem ItemType="HyperSlab" Dimensions="1 {n}{three}">
       <DataItem Format="XML" Dimensions="3 {rank}">{row} 0{zero}  1 1{one}  1 {n}{three}</DataItem>
       <DataItem Format="HDF" NumberType="Float" Precision="4"
                 Dimensions="{rows} {n}{three}">{h5}:/frames/{name}</DataItem>
      </DataItem>
     </Attribute>
)",
      fmt::arg("name", name), fmt::arg("type", vectors ? "Vector" : "Scalar"), fmt::arg("rank", vectors ? 3 : 2),
      fmt::arg("three", vectors ? " 3" : ""), fmt::arg("zero", vectors ? " 0" : ""),
      fmt::arg("one", vectors ? " 1" : ""), fmt::arg("h5", html_text(h5)), fmt::arg("n", vertices),
      fmt::arg("row", row), fmt::arg("rows", rows));
}

std::string contact_forces(const std::string& h5, Eigen::Index vertices, std::size_t row, std::size_t rows) {
  return attribute("contact_normal", h5, vertices, true, row, rows) +
         attribute("contact_friction", h5, vertices, true, row, rows) +
         attribute("contact_pressure", h5, vertices, false, row, rows);
}

// One mesh at one time, with its attributes: row `row` of the array `points`, which has `rows` of them.
std::string grid(const std::string& name, const std::string& h5, const std::string& triangles,
                 Eigen::Index triangle_count, const std::string& points, Eigen::Index vertices, std::size_t row,
                 std::size_t rows, const std::string& attributes = {}) {
  return fmt::format(R"(    <Grid Name="{name}">
     <Topology TopologyType="Triangle" NumberOfElements="{m}">
      <DataItem Format="HDF" NumberType="Int" Dimensions="{m} 3">{h5}:/{triangles}</DataItem>
     </Topology>
     <Geometry GeometryType="XYZ">
      <DataItem ItemType="HyperSlab" Dimensions="1 {n} 3">
       <DataItem Format="XML" Dimensions="3 3">{row} 0 0  1 1 1  1 {n} 3</DataItem>
       <DataItem Format="HDF" NumberType="Float" Precision="4" Dimensions="{rows} {n} 3">{h5}:/{points}</DataItem>
      </DataItem>
     </Geometry>
{attributes}    </Grid>
)",
                     fmt::arg("name", html_text(name)), fmt::arg("h5", html_text(h5)), fmt::arg("triangles", triangles),
                     fmt::arg("m", triangle_count), fmt::arg("points", points), fmt::arg("n", vertices),
                     fmt::arg("row", row), fmt::arg("rows", rows), fmt::arg("attributes", attributes));
}

}  // namespace

std::string xdmf_text(const TrajectoryInfo& info, const std::vector<double>& times, const std::string& h5_name) {
  std::string text = R"(<?xml version="1.0"?>
<Xdmf Version="3.0">
 <Domain>
  <Grid Name="run" GridType="Collection" CollectionType="Temporal">
)";
  for (std::size_t i = 0; i < times.size(); ++i) {
    text += fmt::format("   <Grid Name=\"frame {}\" GridType=\"Collection\">\n    <Time Value=\"{}\"/>\n", i, times[i]);
    text +=
        grid("cloth", h5_name, "cloth/triangles", info.triangles.rows(), "frames/x", info.rest.rows(), i, times.size(),
             info.contact_forces ? contact_forces(h5_name, info.rest.rows(), i, times.size()) : std::string());
    for (std::size_t k = 0; k < info.obstacles.size(); ++k) {
      const TrajectoryInfo::Body& body = info.obstacles[k];
      const std::string place = "obstacles/" + std::to_string(k);
      text += grid(body.name, h5_name, place + "/triangles", body.triangles.rows(), place + "/x", body.vertex_count,
                   body.moving ? i : 0, body.moving ? times.size() : 1);
    }
    text += "   </Grid>\n";
  }
  return text + "  </Grid>\n </Domain>\n</Xdmf>\n";
}

std::filesystem::path write_xdmf(const std::filesystem::path& trajectory) {
  const TrajectoryReader reader(trajectory);
  std::vector<double> times;
  for (int i = 0; i < reader.frame_count(); ++i) times.push_back(reader.time(i));
  std::filesystem::path path = trajectory;
  path.replace_extension(".xdmf");
  write_file(path, xdmf_text(reader.info(), times, trajectory.filename().string()));
  return path;
}

}  // namespace selvedge
