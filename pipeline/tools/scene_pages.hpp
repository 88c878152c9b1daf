#pragma once

#include <string>

namespace selvedge {

// Keys of a first scene, and all others. Each key of a scene file is in one tier.
enum class KeyTier { user, expert };

// The keys of a tier as Markdown, the user's by task: docs/scene.md and docs/expert.md below `<!-- tables -->`.
std::string scene_reference(KeyTier);
// The keys for a terminal, by section: unit, default, meaning.
std::string scene_keys_text(KeyTier);
int scene_key_count(KeyTier);

}  // namespace selvedge
