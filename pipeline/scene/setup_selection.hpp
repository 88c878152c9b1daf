#pragma once

#include "pipeline/config/config.hpp"
#include "pipeline/scene/cloth_part.hpp"

// What a section says of things that other sections made: one of a list by its name, vertices of a cloth.
namespace selvedge {

// Which of `all`, each of which has a name, a value names. Throws Error where it names none.
template <class Named>
int index_of(const Config& name, const std::vector<Named>& all) {
  std::vector<std::string> known;
  for (const Named& one : all) {
    if (one.name == name.text()) return static_cast<int>(known.size());
    known.push_back(one.name);
  }
  name.fail("names `" + name.text() + "`, which is not in the scene",
            known.empty() ? "there is none" : "known: " + joined(known) + suggestion(name.text(), known));
}

// How many vertices a part had in its file, or when it was made, and the number in the part of one of these. They
// differ where vertices were welded or sewn.
Eigen::Index vertices_as_read(const ClothPart&);
int number_here(const ClothPart&, int v);

// The vertices that `vertices`, `box` or `group` of a section name; all where it names none. Vertices that are listed
// keep their order and have the numbers that they were read or made with; those that come back have the part's own.
std::vector<int> read_vertices(const Config& section, const ClothPart&);
std::vector<int> read_selection(const Config& section, const ClothPart&);  // the same, ascending, each once

// What the section names, for people: "of group top", "of a box".
std::string selection_text(const Config& section);

}  // namespace selvedge
