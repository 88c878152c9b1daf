#include "physics/solve/assembly.hpp"

#include <algorithm>
#include <cassert>

#include "collision/geometry/parallel.hpp"
#include "physics/energies/hinge_lanes.hpp"
#include "physics/energies/membrane_lanes.hpp"

namespace selvedge {
namespace {

constexpr int assembly_chunk = 128;  // elements of one task; fixed, so that sums do not depend on the number of threads

int element_count(const Elastic& elastic) { return static_cast<int>(elastic.element_begin.size()) - 1; }
template <class Nodes>
void append_element(Elastic& elastic, const Nodes& nodes) {
  const int count = static_cast<int>(nodes.size());
  elastic.element_nodes.insert(elastic.element_nodes.end(), nodes.begin(), nodes.end());
  elastic.element_begin.push_back(static_cast<int>(elastic.element_nodes.size()));
  elastic.pair_begin.push_back(elastic.pair_begin.back() + count * (count - 1) / 2);
}

void make_gather_lists(Elastic& elastic, int vertices) {
  elastic.force_slots = indices_by_value(elastic.element_nodes, vertices);
  std::vector<int> pair_of_slot;
  pair_of_slot.reserve(elastic.pair_begin.back());
  for (int e = 0; e < element_count(elastic); ++e)
    for (int i = elastic.element_begin[e]; i < elastic.element_begin[e + 1]; ++i)
      for (int j = i + 1; j < elastic.element_begin[e + 1]; ++j)
        pair_of_slot.push_back(find_pair(elastic.pattern, elastic.element_nodes[i], elastic.element_nodes[j]));
  const int pairs = static_cast<int>(elastic.pattern.pairs.size());
  std::vector<int> pair_of_place;
  elastic.pair_place.reserve(pair_of_slot.size());
  std::vector<char> met(pairs, false);
  for (const int pair : pair_of_slot) {
    elastic.pair_place.push_back(met[pair] ? static_cast<int>(pair_of_place.size()) : ~pair);
    if (met[pair]) pair_of_place.push_back(pair);
    met[pair] = true;
  }
  elastic.further = indices_by_value(pair_of_place, pairs);
}

// Where elements write their results. `hessian` null: no pair blocks are wanted.
struct Slots {
  const Elastic& elastic;
  bool forces;
  PairBlocks* hessian;
  AssemblyScratch& scratch;

  Mat3& pair(int slot) const {
    const int place = elastic.pair_place[slot];
    return place < 0 ? (*hessian)[~place] : scratch.pairs[place];
  }
};

template <class Gradient, class Hessian>
void store(const Elastic& elastic, int e, const Gradient& gradient, const Hessian& hessian, double weight,
           const Slots& slots) {
  const int first = elastic.element_begin[e], count = elastic.element_begin[e + 1] - first;
  if (slots.forces)
    for (int i = 0; i < count; ++i)
      slots.scratch.forces.row(first + i) = gradient.template segment<3>(3 * i).transpose();
  if (!slots.hessian) return;
  int slot = elastic.pair_begin[e];
  for (int i = 0; i < count; ++i)
    for (int j = i + 1; j < count; ++j, ++slot) {
      const bool ascending = elastic.element_nodes[first + i] < elastic.element_nodes[first + j];
      const int low = ascending ? i : j, high = ascending ? j : i;
      slots.pair(slot) = weight * hessian.template block<3, 3>(3 * low, 3 * high);
    }
}

double weight_of(const Elastic& elastic, int e, HessianForm form) {
  return form == HessianForm::damping ? elastic.element_damping[e] : 1;
}

// The pair blocks of the element in lane l.
template <std::size_t count, class Lanes>
void store_lane(const Elastic& elastic, int e, const std::array<int, count>& nodes, const Lanes& lanes, int l,
                double weight, const Slots& slots) {
  int pair = 0;
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t j = i + 1; j < count; ++j, ++pair) {
      Mat3& block = slots.pair(elastic.pair_begin[e] + pair);
      block = weight * block_of(lanes, pair, l);
      if (nodes[i] > nodes[j]) block.transposeInPlace();
    }
}

void derivatives_of_membranes(const Elastic& elastic, const Points& x, int begin, int end, HessianForm form,
                              const Slots& slots) {
  MembraneLanes lanes;
  for (int first = begin; first < end; first += lanes.count) {
    std::span<const MembraneElement> elements(elastic.membrane.data() + first, end - first);
    elements = elements.first(together(elastic.materials, elements));
    membrane_derivatives(elastic.materials, elements, x, slots.hessian, form != HessianForm::exact, lanes);
    for (int l = 0; l < lanes.count; ++l) {
      const int e = first + l, slot = elastic.element_begin[e];
      const auto corner = [&](int k) {
        return Vec3(lanes.force[3 * k][l], lanes.force[3 * k + 1][l], lanes.force[3 * k + 2][l]);
      };
      if (slots.forces) {
        slots.scratch.forces.row(slot) = -(corner(0) + corner(1)).transpose();
        for (int k = 0; k < 2; ++k) slots.scratch.forces.row(slot + 1 + k) = corner(k).transpose();
      }
      if (slots.hessian) store_lane(elastic, e, elements[l].nodes, lanes, l, weight_of(elastic, e, form), slots);
    }
  }
}

void derivatives_of_hinges(const Elastic& elastic, const Points& x, int begin, int end, HessianForm form,
                           const Slots& slots) {
  const int hinges_begin = static_cast<int>(elastic.membrane.size());
  HingeLanes lanes;
  for (int first = begin; first < end; first += lanes.count) {
    const std::span<const Hinge> hinges(elastic.hinges.data() + (first - hinges_begin), end - first);
    hinge_energies(hinges, x, true, lanes);
    if (slots.hessian) hinge_hessians(form != HessianForm::exact, lanes);
    for (int l = 0; l < lanes.count; ++l) {
      const int e = first + l, slot = elastic.element_begin[e];
      if (slots.forces)
        for (int k = 0; k < 12; ++k) slots.scratch.forces(slot + k / 3, k % 3) = lanes.force[k][l];
      if (slots.hessian) store_lane(elastic, e, hinges[l].nodes, lanes, l, weight_of(elastic, e, form), slots);
    }
  }
}

// Calls `visit` with the number of each joint among elements begin .. end - 1, and with the joint.
template <class Visit>
void for_each_joint(const Elastic& elastic, int joints_begin, int begin, int end, const Visit& visit) {
  for_each_joint_list([&](auto list, const JointKind&) {
    const auto& joints = elastic.joints.*list;
    const int joints_end = joints_begin + static_cast<int>(joints.size());
    for (int e = std::max(begin, joints_begin); e < std::min(end, joints_end); ++e) visit(e, joints[e - joints_begin]);
    joints_begin = joints_end;
  });
}

void derivatives_of_chunk(const Elastic& elastic, const Points& x, int begin, int end, HessianForm form,
                          const Slots& slots) {
  const int hinges_begin = static_cast<int>(elastic.membrane.size());
  const int curved_begin = hinges_begin + static_cast<int>(elastic.hinges.size());
  const int joints_begin = curved_begin + static_cast<int>(elastic.curved.size());
  Eigen::VectorXd gradient;
  Eigen::MatrixXd hessian;
  if (begin < hinges_begin) derivatives_of_membranes(elastic, x, begin, std::min(end, hinges_begin), form, slots);
  if (end > hinges_begin && begin < curved_begin)
    derivatives_of_hinges(elastic, x, std::max(begin, hinges_begin), std::min(end, curved_begin), form, slots);
  for (int e = std::max(begin, curved_begin); e < std::min(end, joints_begin); ++e) {
    curved_derivatives(elastic.curved[e - curved_begin], x, gradient, slots.hessian ? &hessian : nullptr);
    store(elastic, e, gradient, hessian, weight_of(elastic, e, form), slots);
  }
  for_each_joint(elastic, joints_begin, begin, end, [&](int e, const auto& joint) {
    constexpr int size = 3 * std::tuple_size_v<decltype(nodes_of(joint))>;
    Eigen::Matrix<double, size, 1> own_gradient;
    Eigen::Matrix<double, size, size> own_hessian;
    joint_derivatives(joint, x, own_gradient, slots.hessian ? &own_hessian : nullptr, form != HessianForm::exact);
    store(elastic, e, own_gradient, own_hessian, weight_of(elastic, e, form), slots);
  });
}

double energy_of_chunk(const Elastic& elastic, const Points& x, int begin, int end) {
  const int hinges_begin = static_cast<int>(elastic.membrane.size());
  const int curved_begin = hinges_begin + static_cast<int>(elastic.hinges.size());
  const int joints_begin = curved_begin + static_cast<int>(elastic.curved.size());
  double sum = 0;
  if (begin < hinges_begin) {
    const std::span<const MembraneElement> all = elastic.membrane;
    sum = membrane_energy(elastic.materials, all.subspan(begin, std::min(end, hinges_begin) - begin), x);
  }
  if (end > hinges_begin && begin < curved_begin) {
    const int first = std::max(begin, hinges_begin) - hinges_begin;
    const std::span<const Hinge> all = elastic.hinges;
    sum += hinge_energy(all.subspan(first, std::min(end, curved_begin) - hinges_begin - first), x);
  }
  for (int e = std::max(begin, curved_begin); e < std::min(end, joints_begin); ++e)
    sum += curved_energy(elastic.curved[e - curved_begin], x);
  for_each_joint(elastic, joints_begin, begin, end, [&](int, const auto& joint) { sum += joint_energy(joint, x); });
  return sum;
}

}  // namespace

Elastic make_elastic(const Scene& scene) {
  const int vertices = scene.surface.vertex_count;
  Elastic elastic;
  elastic.vertex_damping.assign(vertices, 0.0);
  for (const Cloth& cloth : scene.cloths) {
    elastic.materials.push_back(cloth.material);
    std::fill_n(elastic.vertex_damping.begin() + cloth.first_vertex, cloth.vertex_count,
                cloth.material.stiffness_damping);
  }
  elastic.membrane = membrane_elements(scene);
  elastic.hinges = hinges(scene);
  CurvatureBending bending = curvature_bending(scene);
  elastic.curved = std::move(bending.curved);
  if (bending.flat.nonZeros() > 0) elastic.flat = std::move(bending.flat);
  elastic.flat.makeCompressed();

  elastic.element_begin = elastic.pair_begin = {0};
  for (const MembraneElement& element : elastic.membrane) append_element(elastic, element.nodes);
  for (const Hinge& hinge : elastic.hinges) append_element(elastic, hinge.nodes);
  for (const CurvedVertex& vertex : elastic.curved) append_element(elastic, vertex.nodes);
  for (int e = 0; e < element_count(elastic); ++e)
    elastic.element_damping.push_back(elastic.vertex_damping[elastic.element_nodes[elastic.element_begin[e]]]);
  for_each_joint_list([&](auto list, const JointKind&) {
    elastic.joints.*list = scene.*list;
    for (const auto& joint : scene.*list) {
      const auto nodes = nodes_of(joint);
      assert(std::ranges::adjacent_find(nodes) == nodes.end());
      append_element(elastic, nodes);
      double damping = 0;
      for (const int node : nodes) damping += elastic.vertex_damping[node];
      elastic.element_damping.push_back(damping / static_cast<double>(nodes.size()));
    }
  });

  elastic.pattern = make_pair_pattern(vertices, elastic.element_begin, elastic.element_nodes);
  make_gather_lists(elastic, vertices);
  return elastic;
}

EnergyElements energy_elements(const Elastic& elastic, const Eigen::VectorXd& masses) {
  return {masses, elastic.materials, elastic.membrane, elastic.flat, elastic.curved, elastic.hinges};
}

void append_elastic_energies(const Elastic& elastic, const Points& x, std::vector<double>& energies) {
  const int count = element_count(elastic), rows = elastic.flat.rows() > 0 ? static_cast<int>(x.rows()) : 0;
  const std::size_t first = energies.size();
  const int element_chunks = chunks_of(count, assembly_chunk), tasks = element_chunks + chunks_of(rows, assembly_chunk);
  energies.resize(first + tasks);
#pragma omp parallel for schedule(static, 4) if (tasks > 8)
  for (int c = 0; c < tasks; ++c) {
    if (c < element_chunks) {
      energies[first + c] = energy_of_chunk(elastic, x, c * assembly_chunk, std::min(count, (c + 1) * assembly_chunk));
      continue;
    }
    double sum = 0;
    const int begin = (c - element_chunks) * assembly_chunk;
    for (int i = begin; i < std::min(rows, begin + assembly_chunk); ++i)
      sum += 0.5 * row(x, i).dot(multiply_flat_row(elastic.flat, x, i));
    energies[first + c] = sum;
  }
}

void elastic_derivatives(const Elastic& elastic, const Points& x, AssemblyScratch& scratch, Points* gradient,
                         PairBlocks* hessian, HessianForm form) {
  const int count = element_count(elastic), tasks = chunks_of(count, assembly_chunk),
            vertices = static_cast<int>(x.rows());
  const int pairs = static_cast<int>(elastic.pattern.pairs.size());
  if (gradient) {
    scratch.forces.resize(elastic.element_nodes.size(), 3);
    gradient->resize(vertices, 3);
  }
  if (hessian) {
    scratch.pairs.resize(elastic.further.item.size());
    hessian->resize(pairs);
  }
  const Slots slots{elastic, gradient != nullptr, hessian, scratch};
#pragma omp parallel if (tasks > 8)
  {
#pragma omp for schedule(dynamic)  // an element's cost depends on its kind
    for (int c = 0; c < tasks; ++c)
      derivatives_of_chunk(elastic, x, c * assembly_chunk, std::min(count, (c + 1) * assembly_chunk), form, slots);
    if (gradient) {
#pragma omp for schedule(static) nowait
      for (int i = 0; i < vertices; ++i) {
        Vec3 sum = Vec3::Zero();
        for (const int slot : elastic.force_slots.of(i)) sum += row(scratch.forces, slot);
        if (elastic.flat.rows() > 0) sum += multiply_flat_row(elastic.flat, x, i);
        gradient->row(i) = sum.transpose();
      }
    }
    if (hessian) {
#pragma omp for schedule(static)
      for (int p = 0; p < pairs; ++p) {
        Mat3& sum = (*hessian)[p];
        for (const int place : elastic.further.of(p)) sum += scratch.pairs[place];
      }
    }
  }
}

}  // namespace selvedge
