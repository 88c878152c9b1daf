#include "physics/linear/linear_system.hpp"

#include "collision/geometry/lists.hpp"

namespace selvedge {
namespace {

Vec3 contact_response(const ContactBlock& contact, const Points& u) {
  Vec3 slip = Vec3::Zero();
  for (int k = 0; k < 4; ++k)
    if (contact.nodes[k] >= 0) slip += contact.weights[k] * row(u, contact.nodes[k]);
  const double along = contact.normal.dot(slip);
  return contact.tangent_stiffness * slip +
         (contact.normal_stiffness - contact.tangent_stiffness) * along * contact.normal;
}

}  // namespace

Vec3 multiply_flat_row(const SparseMatrix& flat, const Points& u, int i) {
  Vec3 sum = Vec3::Zero();
  const Vec3 own = row(u, i);
  for (SparseMatrix::InnerIterator entry(flat, i); entry; ++entry)
    sum += entry.value() * (row(u, static_cast<int>(entry.col())) - own);
  return sum;
}

Mat3 contact_matrix(const ContactBlock& contact) {
  return contact.tangent_stiffness * Mat3::Identity() +
         (contact.normal_stiffness - contact.tangent_stiffness) * contact.normal * contact.normal.transpose();
}

ContactLists list_contacts(std::span<const ContactBlock> contacts, int vertices) {
  ContactLists lists;
  if (contacts.empty()) return lists;
  std::vector<int> nodes;
  nodes.reserve(4 * contacts.size());
  for (const ContactBlock& contact : contacts) nodes.insert(nodes.end(), contact.nodes.begin(), contact.nodes.end());
  IndexLists by = indices_by_value(nodes, vertices);
  lists.weight.reserve(by.item.size());
  for (int& i : by.item) {
    lists.weight.push_back(contacts[i / 4].weights[i % 4]);
    i /= 4;
  }
  lists.begin = std::move(by.begin);
  lists.contact = std::move(by.item);
  return lists;
}

void multiply(const LinearSystem& system, const Points& u, Points& y) {
  const int rows = system.pattern.rows;
  y.resize(rows, 3);
  std::vector<Vec3> responses(system.contacts.size());
  for (std::size_t c = 0; c < responses.size(); ++c) responses[c] = contact_response(system.contacts[c], u);
#pragma omp parallel for schedule(static) if (rows > 1000)
  for (int i = 0; i < rows; ++i) {
    Vec3 sum = Vec3::Zero();
    if (system.free[i]) {
      sum = system.diagonal[i] * row(u, i) + multiply_row(system.pattern, system.pairs, u, i);
      if (system.flat.rows() > 0) sum += system.flat_scale[i] * multiply_flat_row(system.flat, u, i);
      if (!system.lists.begin.empty())
        for (int k = system.lists.begin[i]; k < system.lists.begin[i + 1]; ++k)
          sum += system.lists.weight[k] * responses[system.lists.contact[k]];
    }
    y.row(i) = sum.transpose();
  }
}

void diagonal_blocks(const LinearSystem& system, std::vector<Mat3>& blocks) {
  const int rows = system.pattern.rows;
  blocks.resize(rows);
#pragma omp parallel for schedule(static) if (rows > 1000)
  for (int i = 0; i < rows; ++i) {
    Mat3 block = diagonal_block(system.pattern, system.pairs, i);
    double scalar = system.diagonal[i];
    if (system.flat.rows() > 0) scalar += system.flat_scale[i] * system.flat.coeff(i, i);
    block.diagonal().array() += scalar;
    if (!system.lists.begin.empty())
      for (int k = system.lists.begin[i]; k < system.lists.begin[i + 1]; ++k)
        block +=
            system.lists.weight[k] * system.lists.weight[k] * contact_matrix(system.contacts[system.lists.contact[k]]);
    blocks[i] = block;
  }
}

}  // namespace selvedge
