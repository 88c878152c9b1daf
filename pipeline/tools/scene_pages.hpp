#pragma once

#include <string>

namespace selvedge {

// Which keys of a scene file most scenes need, and which few do. Each key is in one tier.
enum class KeyTier { user, expert };

// The keys of a tier as Markdown, the user's by task: the second halves of docs/scene.md and docs/expert.md.
std::string scene_reference(KeyTier);
// The same as lines for a terminal, dotted keys with their units, defaults and meanings.
std::string scene_keys_text(KeyTier);
int scene_key_count(KeyTier);

}  // namespace selvedge
