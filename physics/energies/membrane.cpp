#include "physics/energies/membrane.hpp"

#include <Eigen/LU>
#include <cassert>
#include <cmath>

#include "physics/energies/membrane_density.hpp"
#include "physics/energies/membrane_lanes.hpp"

namespace selvedge {
namespace {

void load(const Material& material, const MembraneElement& element, const Points& x, int l, MembraneLanes& lanes) {
  for (int side = 0; side < 2; ++side)
    for (int k = 0; k < 3; ++k) lanes.edge[3 * side + k][l] = x(element.nodes[side + 1], k) - x(element.nodes[0], k);
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j) lanes.inverse[2 * i + j][l] = element.inverse(i, j);
  lanes.area[l] = element.area;
  lanes.mu[l] = material.lame_mu;
  lanes.lambda[l] = material.lame_lambda;
}

// Lanes that are not in use take after the last one: arithmetic over all of them then meets no odd numbers.
void load(std::span<const Material> materials, std::span<const MembraneElement> elements, const Points& x,
          MembraneLanes& lanes) {
  assert(!elements.empty() && elements.size() <= MembraneLanes::width);
  lanes.count = static_cast<int>(elements.size());
  for (int l = 0; l < MembraneLanes::width; ++l) {
    const MembraneElement& element = elements[std::min(l, lanes.count - 1)];
    load(materials[element.material], element, x, l, lanes);
  }
}

void store(const MembraneDensity& density, bool hessian, int l, MembraneLanes& lanes) {
  for (int k = 0; k < 2; ++k) {
    lanes.axis_a[k][l] = density.axes(k, 0);
    lanes.axis_b[k][l] = density.axes(k, 1);
  }
  for (int i = 0, above = 0; i < 3; ++i) {
    lanes.stress_a[i][l] = density.stress_a[i];
    lanes.stress_b[i][l] = density.stress_b[i];
    for (int j = 0; j < 3 && hessian; ++j) {
      lanes.ab[3 * i + j][l] = density.hessian_ab(i, j);
      if (j < i) continue;
      lanes.aa[above][l] = density.hessian_aa(i, j);
      lanes.bb[above++][l] = density.hessian_bb(i, j);
    }
  }
}

// From densities to corners 1 and 2: a and b answer to corner i + 1 by the rows of `inverse` times the axes.
SELVEDGE_CLONES void add_up_at_corners(bool hessian, MembraneLanes& lanes) {
  constexpr int above[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};
  double a[2][MembraneLanes::width], b[2][MembraneLanes::width];
  for (int i = 0; i < 2; ++i)
    for (int l = 0; l < MembraneLanes::width; ++l) {
      a[i][l] = lanes.inverse[2 * i][l] * lanes.axis_a[0][l] + lanes.inverse[2 * i + 1][l] * lanes.axis_a[1][l];
      b[i][l] = lanes.inverse[2 * i][l] * lanes.axis_b[0][l] + lanes.inverse[2 * i + 1][l] * lanes.axis_b[1][l];
    }
  for (int i = 0; i < 2; ++i)
    for (int k = 0; k < 3; ++k)
      for (int l = 0; l < MembraneLanes::width; ++l)
        lanes.force[3 * i + k][l] = lanes.area[l] * (a[i][l] * lanes.stress_a[k][l] + b[i][l] * lanes.stress_b[k][l]);
  if (!hessian) return;
  // Corner 0 answers as minus the other two together.
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int l = 0; l < MembraneLanes::width; ++l) {
        const double aa = lanes.aa[above[i][j]][l], bb = lanes.bb[above[i][j]][l], ab = lanes.ab[3 * i + j][l],
                     ba = lanes.ab[3 * j + i][l];
        const auto between = [&](int p, int q) {
          return lanes.area[l] *
                 (a[p][l] * a[q][l] * aa + b[p][l] * b[q][l] * bb + a[p][l] * b[q][l] * ab + b[p][l] * a[q][l] * ba);
        };
        const double mixed = between(0, 1);
        lanes.block[0][3 * i + j][l] = -(between(0, 0) + between(1, 0));
        lanes.block[1][3 * i + j][l] = -(mixed + between(1, 1));
        lanes.block[2][3 * i + j][l] = mixed;
      }
}

}  // namespace

std::vector<MembraneElement> membrane_elements(const Scene& scene) {
  std::vector<MembraneElement> elements;
  elements.reserve(scene.rest_triangle.size());
  for (std::size_t c = 0; c < scene.cloths.size(); ++c) {
    const Cloth& cloth = scene.cloths[c];
    for (int t = cloth.first_triangle; t < cloth.first_triangle + cloth.triangle_count; ++t) {
      const RestTriangle& rest = scene.rest_triangle[t];
      Eigen::Matrix2d edges;
      edges << rest.col(1) - rest.col(0), rest.col(2) - rest.col(0);
      const double rest_area = std::abs(area(rest));
      if (!(rest_area > 1e-12 * edges.squaredNorm())) continue;
      const auto corners = scene.surface.triangles.row(t);
      elements.push_back({{corners(0), corners(1), corners(2)}, edges.inverse(), rest_area, static_cast<int>(c), t});
    }
  }
  return elements;
}

Mat32 deformation_gradient(const MembraneElement& element, const Points& x) {
  const Vec3 x0 = row(x, element.nodes[0]);
  Mat32 edges;
  edges << row(x, element.nodes[1]) - x0, row(x, element.nodes[2]) - x0;
  return edges * element.inverse;
}

int together(std::span<const Material> materials, std::span<const MembraneElement> elements) {
  const auto model = [&](std::size_t e) { return materials[elements[e].material].membrane; };
  std::size_t count = 1;
  while (count < std::min<std::size_t>(elements.size(), MembraneLanes::width) && model(count) == model(0)) ++count;
  return static_cast<int>(count);
}

void membrane_energies(std::span<const Material> materials, std::span<const MembraneElement> elements, const Points& x,
                       MembraneLanes& lanes) {
  load(materials, elements, x, lanes);
  const MembraneModel model = materials[elements[0].material].membrane;
  if (model != MembraneModel::baraff_witkin) return isotropic_energies(model, lanes);
  for (int l = 0; l < lanes.count; ++l)
    lanes.energy[l] =
        elements[l].area * baraff_witkin_energy(materials[elements[l].material], deformation_gradient(elements[l], x));
}

double membrane_energy(std::span<const Material> materials, std::span<const MembraneElement> elements,
                       const Points& x) {
  MembraneLanes lanes;
  double sum = 0;
  for (; !elements.empty(); elements = elements.subspan(lanes.count)) {
    membrane_energies(materials, elements.first(together(materials, elements)), x, lanes);
    for (int l = 0; l < lanes.count; ++l) sum += lanes.energy[l];
  }
  return sum;
}

void membrane_derivatives(std::span<const Material> materials, std::span<const MembraneElement> elements,
                          const Points& x, bool hessian, bool psd, MembraneLanes& lanes) {
  load(materials, elements, x, lanes);
  const MembraneModel model = materials[elements[0].material].membrane;
  if (model == MembraneModel::baraff_witkin)
    for (int l = 0; l < MembraneLanes::width; ++l) {
      const MembraneElement& element = elements[std::min(l, lanes.count - 1)];
      store(baraff_witkin_density(materials[element.material], deformation_gradient(element, x), hessian, psd), hessian,
            l, lanes);
    }
  else
    isotropic_densities(model, hessian, psd, lanes);
  add_up_at_corners(hessian, lanes);
}

}  // namespace selvedge
