#include "pipeline/formats/gltf_numbers_tinygltf.hpp"

#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include <fmt/format.h>

#include "pipeline/host/bounds.hpp"

namespace selvedge {
namespace {

// What an accessor, or one half of a sparse one, reads.
struct Stored {
  int view = -1;
  std::size_t offset = 0, count = 0;
  int columns = 1, component = 0, stride = 0;  // stride [bytes], 0: rows follow each other
  bool normalized = false;
};

double number_at(const unsigned char* at, const Stored& stored, const std::string& where) {
  const auto as = [&]<class Value>(Value value) {
    std::memcpy(&value, at, sizeof value);
    const double scale = stored.normalized ? static_cast<double>(std::numeric_limits<Value>::max()) : 1;
    return std::max(static_cast<double>(value) / scale,
                    stored.normalized ? -1.0 : std::numeric_limits<double>::lowest());
  };
  if (stored.component == TINYGLTF_COMPONENT_TYPE_BYTE) return as(std::int8_t{});
  if (stored.component == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE) return as(std::uint8_t{});
  if (stored.component == TINYGLTF_COMPONENT_TYPE_SHORT) return as(std::int16_t{});
  if (stored.component == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT) return as(std::uint16_t{});
  if (stored.component == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT) return as(std::uint32_t{});
  if (stored.component != TINYGLTF_COMPONENT_TYPE_FLOAT) throw Error("is of no known type", where, "export it anew");
  float value;
  std::memcpy(&value, at, sizeof value);
  return value;
}

GltfNumbers stored_numbers(const tinygltf::Model& model, const Stored& stored, const std::string& where) {
  const tinygltf::BufferView& view = gltf_entry(model.bufferViews, stored.view, where);
  const std::vector<unsigned char>& bytes = gltf_entry(model.buffers, view.buffer, where).data;
  const int size = tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(stored.component));
  if (size <= 0 || stored.stride < 0) throw Error("is of no known type", where, "export it anew");
  const std::size_t row = static_cast<std::size_t>(size) * static_cast<std::size_t>(stored.columns),
                    stride = stored.stride > 0 ? static_cast<std::size_t>(stored.stride) : row;
  const auto fits = [](std::size_t begin, std::size_t length, std::size_t whole) {
    return begin <= whole && length <= whole - begin;
  };
  if (stored.count > bytes.size() || !fits(view.byteOffset, view.byteLength, bytes.size()) ||
      (stored.count > 0 && !fits(stored.offset, (stored.count - 1) * stride + row, view.byteLength)))
    throw Error("reaches beyond its buffer", where, "the file is cut short or damaged");
  GltfNumbers all(static_cast<Eigen::Index>(stored.count), stored.columns);
  const unsigned char* begin = bytes.data() + view.byteOffset + stored.offset;
  for (std::size_t i = 0; i < stored.count; ++i)
    for (int k = 0; k < stored.columns; ++k)
      all(static_cast<Eigen::Index>(i), k) =
          number_at(begin + i * stride + static_cast<std::size_t>(k * size), stored, where);
  return all;
}

// Puts the rows that a sparse accessor stores into the others.
void put_sparse(const tinygltf::Model& model, const tinygltf::Accessor& accessor, const std::string& where,
                GltfNumbers& all) {
  const auto& sparse = accessor.sparse;
  if (sparse.count < 0 || sparse.count > all.rows() || sparse.indices.byteOffset < 0 || sparse.values.byteOffset < 0)
    throw Error(fmt::format("stores {} of {} rows", sparse.count, all.rows()), where, "export it anew");
  const auto count = static_cast<std::size_t>(sparse.count);
  const GltfNumbers rows =
      stored_numbers(model,
                     {sparse.indices.bufferView, static_cast<std::size_t>(sparse.indices.byteOffset), count, 1,
                      sparse.indices.componentType},
                     where + ", sparse indices");
  const GltfNumbers values =
      stored_numbers(model,
                     {sparse.values.bufferView, static_cast<std::size_t>(sparse.values.byteOffset), count,
                      static_cast<int>(all.cols()), accessor.componentType, 0, accessor.normalized},
                     where + ", sparse values");
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    if (!(rows(i, 0) >= 0 && rows(i, 0) < static_cast<double>(all.rows())) || rows(i, 0) != std::floor(rows(i, 0)))
      throw Error(fmt::format("names row {} of {}", rows(i, 0), all.rows()), where + ", sparse indices",
                  "export it anew");
    all.row(static_cast<Eigen::Index>(rows(i, 0))) = values.row(i);
  }
}

}  // namespace

GltfNumbers gltf_numbers(const tinygltf::Model& model, int index, int columns, const std::string& where) {
  const tinygltf::Accessor& accessor = gltf_entry(model.accessors, index, where);
  const int has = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type));
  if (has != columns) throw Error(fmt::format("has {} numbers a row, not {}", has, columns), where, "export it anew");
  GltfNumbers all;
  if (accessor.bufferView >= 0) {
    const int stride = accessor.ByteStride(gltf_entry(model.bufferViews, accessor.bufferView, where));
    if (stride <= 0) throw Error("is of no known type", where, "export it anew");
    all = stored_numbers(model,
                         {accessor.bufferView, accessor.byteOffset, accessor.count, columns, accessor.componentType,
                          stride, accessor.normalized},
                         where);
  } else {
    refuse_too_many(static_cast<double>(accessor.count) * columns, most_numbers, "numbers", where, "export less of it");
    all.setZero(static_cast<Eigen::Index>(accessor.count), columns);
  }
  if (accessor.sparse.isSparse) put_sparse(model, accessor, where, all);
  if (!all.allFinite()) throw Error("is not finite", where, "repair it where it was made");
  return all;
}

}  // namespace selvedge
