#pragma once

#include <QString>
#include <cstdint>
#include <optional>

class QWidget;

namespace nearfit::ui {

/// The user's choices for a suggested path.
struct SuggestionRequest {
  enum class Goal : std::uint8_t { ToDrawn, Out };
  Goal goal = Goal::Out;
  double seconds = 30.0;
  double separation = 0.0;  ///< [m]; > 0.
  bool mayTurn = true;
};

/// Asks for goal, time and separation. The goal, the time and the turns asked for last are offered again.
/// @param name        Of what is in hand.
/// @param separation  Offered first, rounded up to 0.01 um [m].
/// @return std::nullopt if the user cancels.
std::optional<SuggestionRequest> askForSuggestion(const QString& name, double separation, QWidget* parent);

}  // namespace nearfit::ui
