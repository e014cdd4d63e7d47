#pragma once

namespace CLI {
class App;
}

namespace nearfit::stress {

void addScenesCommand(CLI::App& program);
void addHandCommand(CLI::App& program);
void addRestCommand(CLI::App& program);
void addLimitCommand(CLI::App& program);
void addHoursCommand(CLI::App& program);
void addOracleCommand(CLI::App& program);

}  // namespace nearfit::stress
