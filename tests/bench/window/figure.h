#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace nearfit::bench {

/// Something a user of the window waits for, or what it costs, in one way.
struct Figure {
  Figure(std::string what, std::string how, std::string ofAll)
      : name(std::move(what)), way(std::move(how)), unit(std::move(ofAll)) {}

  std::string name, way, unit;  ///< What; how, such as with or without something; of all numbers.
  std::size_t count = 0;
  double p50 = 0.0, p99 = 0.0, p999 = 0.0, max = 0.0;
  double goal = 0.0;      ///< At most so much; 0: none, it is there to compare with.
  std::string goalOf;     ///< The column that the goal is for.
  double goalP999 = 0.0;  ///< Max for p99.9; 0: none.
  std::optional<std::uint64_t>
      leftOut;  ///< Ticks of a servo left out, of all turns; no value: not one of a servo.
  std::optional<std::uint64_t> maxLeftOut;  ///< Goal for these; no value: none.
  std::string remark;                       ///< Without commas.
};

/// @param samples  In the figure's unit.
Figure figureOf(std::string name, std::string way, std::string unit, const std::vector<double>& samples);

std::string figureTableHeader();
std::string figureTableLine(const Figure& figure);
std::string figureCsvHeader();
std::string figureCsvLine(const Figure& figure);

/// What is measured, and how long.
struct WindowOptions {
  std::chrono::milliseconds time{4000};  ///< Of each turn.
  std::size_t turns = 3;                 ///< Of each way, one after the other.
  std::size_t starts = 5;
  std::size_t triangles = 100'000;  ///< Of the scene that is turned.
  std::size_t million = 1'000'000;  ///< Of the mesh that is opened and picked.
  std::size_t parts = 1000;         ///< Of the large scene; each with a hundredth of `million` triangles.
  std::size_t picks = 1000;
  std::size_t instances = 300;   ///< Of the assembly that is opened; with `million` triangles in all.
  std::filesystem::path shared;  ///< Folder of the shared models; empty: without.
  std::string program;           ///< This one, for starts.
};

}  // namespace nearfit::bench
