#pragma once

#include <QColor>
#include <QIcon>
#include <QString>

class QApplication;

namespace nearfit::ui {

/// Colours that mean something, the same in widgets and in the 3-D view.
namespace colours {
inline const QColor kAccent(0x1f, 0x73, 0xd0);
inline const QColor kForce(0xd8, 0x2c, 0x20);
inline const QColor kTorque(0x7b, 0x2f, 0xbe);
inline const QColor kContact(0xb0, 0x15, 0x5e);
inline const QColor kHand(0x0b, 0x84, 0x84);
inline const QColor kOverlap(0xe0, 0x3b, 0x2f);
inline const QColor kMoving(0xe2, 0x71, 0x1d);
inline const QColor kMutedText(0x5d, 0x68, 0x74);
inline const QColor kWarning(0xb3, 0x4a, 0x00);
}  // namespace colours

/// The colour that an axis has: 0, 1 or 2; that of the view for -1.
QColor axisColour(int axis);

/// Makes the compiled-in icons of this library known; harmless when repeated.
void loadResources();
/// Light or dark, or as the desktop is.
enum class ColourScheme { System, Light, Dark };

/// What the user has chosen, kept from run to run.
ColourScheme colourScheme();
/// Changes all that is shown at once, and keeps the choice. Widgets write their style sheets in the colours
/// of the light theme; in the dark one those are translated. The view follows QEvent::PaletteChange.
void setColourScheme(ColourScheme scheme);
bool isThemeDark();
/// A style sheet or SVG with each colour of the light theme replaced by that of the dark one.
QString inDarkColours(const QString& light);

/// A colour of the light theme as it is in the present one: for what is drawn, or given to a model's reader,
/// without a style sheet.
QColor themed(const QColor& light);

/// Style, palette, window icon and style sheet of the whole application.
void applyTheme(QApplication& application);
/// An icon of resources/icons by its file name without ending; follows the theme.
QIcon icon(const QString& name);

}  // namespace nearfit::ui
