#include "pipeline/exports/usda_look.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <iterator>

namespace selvedge {
namespace {

std::string in_quotes(const std::string& name) {
  std::string safe;
  for (const char c : name) {
    if (c == '"' || c == '\\') safe += '\\';
    safe += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
  }
  return '"' + safe + '"';
}

// Metadata that keep a name which no prim may have.
std::string name_metadata(const std::string& prim, const std::string& name, const std::string& more = "") {
  const std::string kept = prim == name ? "" : "customData = { string name = " + in_quotes(name) + " }";
  return kept.empty() && more.empty() ? "" : fmt::format(" ({}{}{})", more, more.empty() ? "" : "\n", kept);
}

std::string asset(const std::string& file) {
  return file.find('@') == std::string::npos ? "@" + file + "@" : "@@@" + file + "@@@";
}

std::string list_text(const std::vector<int>& numbers) { return fmt::format("[{}]", fmt::join(numbers, ", ")); }

std::string material_text(const LookMaterial& material, const std::string& prim) {
  const Vec3 c = material.colour.value_or(Vec3::Constant(material.texture.empty() ? 0.7 : 1));
  const std::string path = "/run/Looks/" + prim, colour = fmt::format("{}, {}, {}", c.x(), c.y(), c.z());
  std::string text = fmt::format(
      "        def Material \"{}\"{}\n        {{\n            token outputs:surface.connect = "
      "<{}/Surface.outputs:surface>\n"
      "            def Shader \"Surface\"\n            {{\n                uniform token info:id = "
      "\"UsdPreviewSurface\"\n"
      "                color3f inputs:diffuseColor{}\n                float inputs:roughness = 0.8\n"
      "                token outputs:surface\n            }}\n",
      prim, name_metadata(prim, material.name), path,
      material.texture.empty() ? " = (" + colour + ")" : ".connect = <" + path + "/Texture.outputs:rgb>");
  if (!material.texture.empty())
    text += fmt::format(
        "            def Shader \"Texture\"\n            {{\n                uniform token info:id = \"UsdUVTexture\"\n"
        "                asset inputs:file = {}\n                float4 inputs:scale = ({}, 1)\n"
        "                token inputs:wrapS = \"repeat\"\n                token inputs:wrapT = \"repeat\"\n"
        "                float2 inputs:st.connect = <{}/Reader.outputs:result>\n                float3 outputs:rgb\n"
        "            }}\n            def Shader \"Reader\"\n            {{\n"
        "                uniform token info:id = \"UsdPrimvarReader_float2\"\n"
        "                string inputs:varname = \"st\"\n                float2 outputs:result\n            }}\n",
        asset(material.texture), colour, path);
  return text + "        }\n";
}

// The rows of uv that corners have, and one of zeros behind them for corners without.
std::string uv_text(const Look& look) {
  std::string rows;
  for (const auto& uv : look.uv.rowwise())
    fmt::format_to(std::back_inserter(rows), "{}({}, {})", rows.empty() ? "" : ", ", static_cast<float>(uv[0]),
                   static_cast<float>(uv[1]));
  std::vector<int> indices = look.corner_uv;
  if (std::ranges::count(indices, -1) > 0) rows += rows.empty() ? "(0, 0)" : ", (0, 0)";
  std::ranges::replace(indices, -1, static_cast<int>(look.uv.rows()));
  return fmt::format(
      "        texCoord2f[] primvars:st = [{}] (\n            interpolation = \"faceVarying\"\n        )\n"
      "        int[] primvars:st:indices = {}\n",
      rows, list_text(indices));
}

std::vector<int> faces_with(const std::vector<int>& of_face, int number) {
  std::vector<int> faces;
  for (std::size_t f = 0; f < of_face.size(); ++f)
    if (of_face[f] == number) faces.push_back(static_cast<int>(f));
  return faces;
}

std::string subset_text(const std::string& prim, const std::string& metadata, const std::string& family,
                        const std::vector<int>& faces, const std::string& more) {
  return fmt::format(
      "        def GeomSubset \"{}\"{}\n        {{\n            uniform token elementType = \"face\"\n"
      "            uniform token familyName = \"{}\"\n            int[] indices = {}\n{}        }}\n",
      prim, metadata, family, list_text(faces), more);
}

// One material of all faces is that of the mesh; several have a subset each.
std::string bindings_text(const Look& look, const std::vector<std::string>& materials, PrimNames& names) {
  if (materials.empty()) return {};
  if (std::ranges::count(look.face_material, look.face_material[0]) == look.faces())
    return look.face_material[0] < 0 ? ""
                                     : fmt::format("        rel material:binding = <{}>\n",
                                                   materials[static_cast<std::size_t>(look.face_material[0])]);
  std::string text = "        uniform token subsetFamily:materialBind:familyType = \"nonOverlapping\"\n";
  for (std::size_t m = 0; m < materials.size(); ++m) {
    const std::vector<int> faces = faces_with(look.face_material, static_cast<int>(m));
    if (faces.empty()) continue;
    const std::string prim = names(look.materials[m].name);
    text +=
        subset_text(prim, name_metadata(prim, look.materials[m].name, "prepend apiSchemas = [\"MaterialBindingAPI\"]"),
                    "materialBind", faces, fmt::format("            rel material:binding = <{}>\n", materials[m]));
  }
  return text;
}

std::string parts_text(const Look& look, PrimNames& names) {
  std::string text;
  for (std::size_t p = 0; p < look.parts.size(); ++p) {
    const LookPart& part = look.parts[p];
    const std::string& name = part.groups.empty() ? part.object : part.groups;
    if (name.empty() || (look.parts.size() == 1 && part.groups.empty())) continue;
    const std::string prim = names(name);
    text += subset_text(prim, name_metadata(prim, name), "parts", faces_with(look.face_part, static_cast<int>(p)), "");
  }
  return text;
}

}  // namespace

std::string PrimNames::operator()(const std::string& given) {
  std::string name = given;
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  if (name.empty() || std::isdigit(static_cast<unsigned char>(name[0]))) name = "_" + name;
  std::string free = name;
  for (int k = 1; !taken.insert(free).second; ++k) free = fmt::format("{}_{}", name, k);
  return free;
}

UsdMaterials usd_materials(const ExportMaterials& materials) {
  UsdMaterials usd;
  PrimNames names;
  for (const LookMaterial& material : materials.all) {
    const std::string prim = names(material.name);
    usd.paths.push_back("/run/Looks/" + prim);
    usd.text += material_text(material, prim);
  }
  if (!usd.text.empty()) usd.text = "    def Scope \"Looks\"\n    {\n" + usd.text + "    }\n";
  return usd;
}

std::string usd_rows(const PointsF& rows, int digits) {
  std::string text;
  for (Eigen::Index i = 0; i < rows.rows(); ++i)
    fmt::format_to(std::back_inserter(text), "{}({:.{}f}, {:.{}f}, {:.{}f})", i > 0 ? ", " : "", rows(i, 0), digits,
                   rows(i, 1), digits, rows(i, 2), digits);
  return text;
}

std::string usd_look_text(const Look& look, const std::vector<std::string>& materials) {
  std::vector<int> counts;
  for (int face = 0; face < look.faces(); ++face) counts.push_back(look.end_of(face) - look.begin_of(face));
  std::string text = "        int[] faceVertexCounts = " + list_text(counts) +
                     "\n        int[] faceVertexIndices = " + list_text(look.corners) + "\n";
  if (!look.corner_uv.empty()) text += uv_text(look);
  PrimNames names;
  text += bindings_text(look, materials, names);
  return text + parts_text(look, names);
}

std::string usd_normals_text(const NormalSlots& slots) {
  return fmt::format(
      "        normal3f[] primvars:normals (\n            interpolation = \"faceVarying\"\n        )\n"
      "        int[] primvars:normals:indices = {}\n",
      list_text(slots.of_corner));
}

}  // namespace selvedge
