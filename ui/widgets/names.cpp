#include "ui/widgets/names.h"

#include <QObject>
#include <algorithm>

namespace nearfit::ui {
namespace {

constexpr int kMaxCharacters = 40;
/// Letters without a break that fit wherever a text wraps.
constexpr int kUnbroken = 16;
constexpr QChar kCut(0x2026), kMayBreak(0x200B);

}  // namespace

QString shortName(const QString& name) {
  if (name.size() <= kMaxCharacters) return name;
  const int begin = kMaxCharacters / 2, end = kMaxCharacters - begin - 1;
  return name.left(begin) + kCut + name.right(end);
}

QString shortName(const std::string& name) {
  return shortName(QString::fromStdString(name));
}

QString breakable(const QString& text) {
  QString result;
  int unbroken = 0;
  for (const QChar letter : text) {
    unbroken = letter.isSpace() ? 0 : unbroken + 1;
    // Do not split a surrogate pair.
    if (unbroken > kUnbroken && !letter.isLowSurrogate()) {
      result += kMayBreak;
      unbroken = 1;
    }
    result += letter;
  }
  return result;
}

QString listOfNames(const QStringList& names, int most, int count) {
  QStringList said;
  for (const QString& name : names.mid(0, most))
    said << shortName(name);
  const int more = std::max(count, static_cast<int>(names.size())) - static_cast<int>(said.size());
  if (more <= 0 && said.size() <= 1) return said.join(QString());
  const QString last = more > 0 ? QObject::tr("%1 more").arg(more) : said.takeLast();
  return QObject::tr("%1 and %2").arg(said.join(QStringLiteral(", ")), last);
}

}  // namespace nearfit::ui
