#pragma once

/// What figures are printed in.
namespace nearfit::bench {

constexpr double kMicro = 1e6;     ///< Microseconds in a second.
constexpr double kMegabyte = 1e6;  ///< Bytes in one.

}  // namespace nearfit::bench
