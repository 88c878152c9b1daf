#pragma once

namespace selvedge {

// Limits of a network. Files and options that exceed them are refused.
inline constexpr int most_latents = 4096;
inline constexpr int most_message_steps = 1024;

}  // namespace selvedge
