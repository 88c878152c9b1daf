#include <cstdlib>

#include "pipeline/formats/mesh_io.hpp"
#include "pipeline/formats/mesh_weld.hpp"
#include "tests/fuzz/fuzzed_file.hpp"

using namespace selvedge;

// What is read holds together, is welded, and is read again from what is written of it.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return fuzz::read_or_refuse([&] {
    Mesh mesh = read_mesh(fuzz::file_of(".ply", fuzz::text_of(data, size)));
    if (!mesh.x.allFinite() || mesh.triangles.minCoeff() < 0 || mesh.triangles.maxCoeff() >= mesh.x.rows())
      std::abort();
    weld(mesh, "fuzzed");
    if (mesh.triangles.rows() > 0 && mesh.triangles.maxCoeff() >= mesh.x.rows()) std::abort();
  });
}
