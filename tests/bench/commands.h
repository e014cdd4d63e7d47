#pragma once

namespace CLI {
class App;
}

namespace nearfit::bench {

void addQueryCommand(CLI::App& program);
void addBuildCommand(CLI::App& program);
void addSceneCommand(CLI::App& program);
void addProgramCommand(CLI::App& program);
void addCheckCommand(CLI::App& program);
void addCertifyCommand(CLI::App& program);
void addPathCommand(CLI::App& program);
void addSuggestCommand(CLI::App& program);
void addVerdictsCommand(CLI::App& program);
void addFeelCommand(CLI::App& program);
void addErrorCommand(CLI::App& program);
void addPaperCommand(CLI::App& program);
void addSkipsCommand(CLI::App& program);
void addImportCommand(CLI::App& program);

}  // namespace nearfit::bench
