#include "physics/membrane.hpp"

#include <Eigen/LU>
#include <cmath>

#include "physics/membrane_density.hpp"

namespace selvedge {

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

double membrane_energy(const Material& material, const MembraneElement& element, const Points& x) {
  const Mat32 F = deformation_gradient(element, x);
  return element.area * (material.membrane == MembraneModel::baraff_witkin ? baraff_witkin_energy(material, F)
                                                                           : isotropic_energy(material, F));
}

double membrane_derivatives(const Material& material, const MembraneElement& element, const Points& x, Vec9& gradient,
                            Mat9* hessian, bool psd) {
  const Mat32 F = deformation_gradient(element, x);
  const MembraneDensity density = material.membrane == MembraneModel::baraff_witkin
                                      ? baraff_witkin_density(material, F, hessian != nullptr, psd)
                                      : isotropic_density(material, F, hessian != nullptr, psd);
  // Row i: how a and b answer to corner i + 1. Corner 0 is minus the other two: forces and Hessian sum to zero.
  const Eigen::Matrix2d shape = element.inverse * density.axes;
  gradient.setZero();
  for (int i = 0; i < 2; ++i) {
    const Vec3 force = element.area * (shape(i, 0) * density.stress_a + shape(i, 1) * density.stress_b);
    gradient.segment<3>(3 * i + 3) = force;
    gradient.head<3>() -= force;
  }
  if (!hessian) return element.area * density.energy;

  hessian->topLeftCorner<3, 3>().setZero();
  for (int i = 0; i < 2; ++i)
    for (int j = i; j < 2; ++j) {
      const Mat3 block =
          element.area *
          (shape(i, 0) * shape(j, 0) * density.hessian_aa + shape(i, 1) * shape(j, 1) * density.hessian_bb +
           shape(i, 0) * shape(j, 1) * density.hessian_ab + shape(i, 1) * shape(j, 0) * density.hessian_ab.transpose());
      hessian->block<3, 3>(3 * i + 3, 3 * j + 3) = block;
      hessian->block<3, 3>(3 * j + 3, 3 * i + 3) = block.transpose();
    }
  for (int i = 1; i < 3; ++i) {
    const Mat3 sum = hessian->block<3, 3>(3 * i, 3) + hessian->block<3, 3>(3 * i, 6);
    hessian->block<3, 3>(3 * i, 0) = -sum;
    hessian->block<3, 3>(0, 3 * i) = -sum.transpose();
    hessian->topLeftCorner<3, 3>() += sum;
  }
  return element.area * density.energy;
}

}  // namespace selvedge
