#include "kiosk/display/ui/strings.hpp"

#include <algorithm>
#include <array>

namespace lackwerk::kiosk::ui {
namespace {

struct Line {
  Text what;
  std::array<std::string_view, languages> in;  ///< in the order of Language
};

constexpr auto text_count = static_cast<std::size_t>(Text::count_);

constexpr std::array<Line, text_count> table{{
    {Text::touch_to_begin, {"Touch to begin", "Zum Entdecken berühren", "المس لتبدأ"}},
    {Text::touch_to_stay, {"Touch to stay", "Berühren, um zu bleiben", "المس للبقاء"}},
    {Text::your_mix, {"Your mix", "Ihre Mischung", "مزيجك"}},
    {Text::nearest_paint, {"Nearest paint", "Nächster Lack", "أقرب طلاء"}},
    {Text::colour_difference, {"CIEDE2000", "CIEDE2000", "CIEDE2000"}},
    {Text::take_home_title, {"Take it home", "Zum Mitnehmen", "خذه معك"}},
    {Text::take_home_how,
     {"Photograph this code. Your dealer will show you this very paint again.",
      "Fotografieren Sie diesen Code. Ihr Händler zeigt Ihnen genau diesen Lack wieder.",
      "صوّر هذا الرمز، وسيعرض لك الوكيل هذا الطلاء نفسه مرة أخرى."}},
    {Text::colour_and_gloss, {"Colour and gloss", "Farbe und Glanz", "اللون واللمعان"}},
    {Text::flakes, {"Flakes", "Flakes", "الرقائق المعدنية"}},
    {Text::clear_coat, {"Clear coat", "Klarlack", "الطبقة الشفافة"}},
    {Text::source, {"Source", "Quelle", "المصدر"}},
    {Text::measured, {"measured", "gemessen", "مُقاس"}},
    {Text::published_fit, {"published fit", "veröffentlichte Anpassung", "مواءمة منشورة"}},
    {Text::simulated, {"simulated", "simuliert", "محاكاة"}},
    {Text::calm, {"calm", "ruhig", "هادئ"}},
    {Text::gentle, {"gentle", "sanft", "ناعم"}},
    {Text::lively, {"lively", "lebhaft", "متلألئ"}},
    {Text::white_flakes, {"white flakes", "weiße Flakes", "رقائق بيضاء"}},
    {Text::dealer, {"Dealer", "Händler", "الوكيل"}},
    {Text::pin_prompt, {"Enter the PIN", "PIN eingeben", "أدخل الرمز السري"}},
    {Text::pin_refused, {"Wrong PIN, {} attempts left", "Falsche PIN, noch {} Versuche", "رمز خاطئ، المتبقي: {}"}},
    {Text::pin_locked, {"Locked for {} s", "Gesperrt für {} s", "مقفل لمدة {} ثانية"}},
    {Text::packs, {"Packs", "Pakete", "الحزم"}},
    {Text::status, {"Status", "Status", "الحالة"}},
    {Text::devices, {"Devices", "Geräte", "الأجهزة"}},
    {Text::errors, {"Errors", "Fehler", "الأخطاء"}},
    {Text::screen, {"Screen", "Bildschirm", "الشاشة"}},
    {Text::options, {"Options", "Optionen", "الخيارات"}},
    {Text::no_packs, {"No packs", "Keine Pakete", "لا توجد حزم"}},
    {Text::unsigned_pack, {"Unsigned paints", "Lacke ohne Signatur", "دهانات بلا توقيع"}},
    {Text::unsigned_scans, {"Unsigned scans", "Scans ohne Signatur", "مسوحات بلا توقيع"}},
    {Text::no_devices, {"No devices", "Keine Geräte", "لا توجد أجهزة"}},
    {Text::no_errors, {"No errors", "Keine Fehler", "لا توجد أخطاء"}},
    {Text::new_paints, {"New paints are in: {}", "Neue Lacke sind da: {}", "وصلت دهانات جديدة: {}"}},
    {Text::known_paints,
     {"These paints are there already: {}", "Diese Lacke sind schon da: {}", "هذه الدهانات موجودة من قبل: {}"}},
    {Text::packs_refused, {"Packs refused: {}", "Abgelehnte Pakete: {}", "الحزم المرفوضة: {}"}},
    {Text::nothing_came, {"Nothing came from the stick", "Vom Stick kam nichts", "لم يصل شيء من وحدة USB"}},
    {Text::last_stick, {"Last USB stick", "Letzter USB-Stick", "آخر وحدة USB"}},
    {Text::stored, {"taken", "übernommen", "أُضيفت"}},
    {Text::already_there, {"already there", "schon da", "موجودة من قبل"}},
    {Text::serial, {"No. {}", "Nr. {}", "رقم {}"}},
    {Text::brightness, {"Brightness", "Helligkeit", "السطوع"}},
    {Text::test_pattern, {"Test pattern", "Testbild", "صورة الاختبار"}},
    {Text::back, {"Back", "Zurück", "رجوع"}},
    {Text::calibrate, {"Calibrate touch", "Touch kalibrieren", "معايرة اللمس"}},
    {Text::calibrate_how,
     {"Touch the middle of the cross", "Berühren Sie die Mitte des Kreuzes", "المس منتصف علامة التقاطع"}},
    {Text::calibration_failed,
     {"The calibration failed. Please try again.", "Die Kalibrierung ist misslungen. Bitte noch einmal versuchen.",
      "فشلت المعايرة. حاول مرة أخرى."}},
    {Text::beyond, {"Beyond the pack's paints", "Über die Lacke des Pakets hinaus", "تجاوز دهانات الحزمة"}},
    {Text::language, {"Language", "Sprache", "اللغة"}},
    {Text::own_name, {"English", "Deutsch", "العربية"}},
    {Text::reduced_motion, {"Reduced motion", "Weniger Bewegung", "تقليل الحركة"}},
    {Text::on, {"on", "ein", "مفعّل"}},
    {Text::off, {"off", "aus", "معطّل"}},
    {Text::state, {"State", "Zustand", "الحالة"}},
    {Text::output, {"Output", "Ausgang", "المخرج"}},
    {Text::renderer, {"Renderer", "Renderer", "محرك الرسم"}},
    {Text::mode, {"Mode", "Modus", "الوضع"}},
    {Text::quality, {"Quality", "Qualität", "الجودة"}},
    {Text::frame_time, {"Frame time", "Bildzeit", "زمن الإطار"}},
    {Text::response_time, {"Touch to picture", "Berührung bis Bild", "من اللمس إلى الصورة"}},
    {Text::still, {"still", "ruhend", "ثابت"}},
    {Text::running, {"running", "läuft", "يعمل"}},
    {Text::waiting_for_display, {"waiting for a display", "wartet auf Bildschirm", "بانتظار شاشة"}},
    {Text::suspended, {"suspended", "angehalten", "معلّق"}},
    {Text::stopped, {"stopped", "beendet", "متوقف"}},
    {Text::ready, {"ready", "bereit", "جاهز"}},
    {Text::waiting, {"waiting", "wartet", "بالانتظار"}},
    {Text::refused, {"refused", "abgelehnt", "مرفوض"}},
    {Text::gone, {"gone", "entfernt", "غير موصول"}},
    {Text::one_event, {"1 event", "1 Ereignis", "حدث واحد"}},
    {Text::events, {"{} events", "{} Ereignisse", "الأحداث: {}"}},
}};

constexpr bool complete() {
  for (std::size_t k = 0; k < table.size(); ++k) {
    if (static_cast<std::size_t>(table[k].what) != k) return false;
    for (const std::string_view words : table[k].in)
      if (words.empty()) return false;
  }
  return true;
}
static_assert(complete(), "every text in every language, in the order of the enumeration");

struct StateWord {
  std::string_view word;
  Text text;
};
constexpr std::array<StateWord, 8> state_words{{{"running", Text::running},
                                                {"waiting_for_display", Text::waiting_for_display},
                                                {"suspended", Text::suspended},
                                                {"stopped", Text::stopped},
                                                {"ready", Text::ready},
                                                {"waiting", Text::waiting},
                                                {"refused", Text::refused},
                                                {"gone", Text::gone}}};

}  // namespace

std::string_view text(Text what, Language language) {
  const auto line = std::min(static_cast<std::size_t>(what), table.size() - 1);
  const auto column = std::min(static_cast<std::size_t>(language), static_cast<std::size_t>(languages - 1));
  return table[line].in[column];
}

namespace {

std::string filled(std::string_view pattern, const std::string& with) {
  std::string out(pattern);
  const std::size_t at = out.find("{}");
  if (at != std::string::npos) out.replace(at, 2, with);
  return out;
}

constexpr std::string_view isolate = "\u2068", end_isolate = "\u2069";

}  // namespace

std::string text_with(Text what, Language language, long long number) {
  return filled(text(what, language), std::to_string(number));
}

std::string text_with(Text what, Language language, std::string_view words) {
  std::string with(words);
  if (right_to_left(language)) with = std::string(isolate) + with + std::string(end_isolate);
  return filled(text(what, language), with);
}

packs::MixWords mix_words(Language language) {
  packs::MixWords words;
  words.calm = text(Text::calm, language);
  words.gentle = text(Text::gentle, language);
  words.lively = text(Text::lively, language);
  words.white_flakes = text(Text::white_flakes, language);
  // The Arabic comma turns the other way.
  if (language == Language::arabic) words.list_separator = "، ";
  words.name = short_name;
  return words;
}

std::string_view short_name(std::string_view name) {
  const std::string_view head = name.substr(0, std::min(name.find(" ("), name.find(',')));
  return head.empty() ? name : head;
}

std::string set_mix_name(std::string_view mix_name, Language language) {
  constexpr std::string_view no_break = "\u00a0";
  // About half a line of the narrowest place for it: longer parts may have to be broken.
  constexpr std::size_t most_unbroken = 40;
  const std::string_view separator = mix_words(language).list_separator;
  std::string out;
  while (!mix_name.empty()) {
    const std::string_view part = mix_name.substr(0, mix_name.find(separator));
    if (right_to_left(language)) out += isolate;
    for (const char c : part)
      if (c == ' ' && part.size() <= most_unbroken)
        out += no_break;
      else
        out += c;
    if (right_to_left(language)) out += end_isolate;
    mix_name.remove_prefix(part.size());
    if (mix_name.empty()) break;
    out += separator;
    mix_name.remove_prefix(separator.size());
  }
  return out;
}

std::string_view provenance_text(core::Provenance provenance, Language language) {
  switch (provenance) {
    case core::Provenance::measured:
      return text(Text::measured, language);
    case core::Provenance::published_fit:
      return text(Text::published_fit, language);
    case core::Provenance::simulated:
      break;
  }
  return text(Text::simulated, language);
}

std::string_view page_text(DealerPage page, Language language) {
  constexpr std::array<Text, dealer_pages> names{Text::packs,  Text::status, Text::devices,
                                                 Text::errors, Text::screen, Text::options};
  return text(names[std::min(static_cast<std::size_t>(page), names.size() - 1)], language);
}

std::string_view state_text(std::string_view word, Language language) {
  for (const StateWord& known : state_words)
    if (known.word == word) return text(known.text, language);
  return word;
}

}  // namespace lackwerk::kiosk::ui
