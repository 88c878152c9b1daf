#pragma once

namespace selvedge {

// What a network may have at most: files and options that ask for more are refused.
inline constexpr int most_latents = 4096;
inline constexpr int most_message_steps = 1024;

}  // namespace selvedge
