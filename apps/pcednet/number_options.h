#pragma once

#include <CLI/CLI.hpp>

#include <cstdint>
#include <functional>
#include <string>

namespace pcednet::app {

/// Checks that a word is a number for which `is_sound`, called with finite numbers only. The
/// message is "WORD is not MEANING".
CLI::Validator number(const std::string& meaning, const std::function<bool(double)>& is_sound);

/// "a number, 0 or more", "a number above 0", "a length above 0, at most 1e150", "a number from 0
/// to 1".
CLI::Validator number_from_0();
CLI::Validator number_above_0();
CLI::Validator length_above_0();
CLI::Validator share();

/// Checks that a word is a whole number from `least` to `most`, in decimal digits, which it leaves
/// without zeros in front: to be given to transform(), as CLI11 reads 010 as 8, -1 as 2^64 - 1 and
/// larger numbers as the largest.
CLI::Validator whole_number(std::uint64_t least, std::uint64_t most);

/// Gives every option of all commands under `app` that takes numbers without sign and has no check
/// that of whole_number(), and reads those of all other whole numbers as decimal digits.
void guard_number_options(CLI::App& app);

}  // namespace pcednet::app
