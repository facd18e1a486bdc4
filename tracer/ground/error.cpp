#include "tracer/ground/error.h"

#include <algorithm>

namespace raywalk {

std::string to_string(const Diagnostic& diagnostic) {
    std::string text = diagnostic.where.file;
    if (diagnostic.where.line > 0)
        text += ":" + std::to_string(diagnostic.where.line) + ":" + std::to_string(diagnostic.where.column);
    text += diagnostic.severity == Severity::error ? ": error: " : ": warning: ";
    text += diagnostic.what;
    if (!diagnostic.source_line.empty()) {
        // Tabs stay tabs under tabs, so that the caret stands where it belongs.
        std::string margin = diagnostic.source_line.substr(0, diagnostic.where.column - 1);
        std::replace_if(margin.begin(), margin.end(), [](char c) { return c != '\t'; }, ' ');
        text += "\n  " + diagnostic.source_line + "\n  " + margin + "^" +
                std::string(std::max<std::size_t>(diagnostic.where.length, 1) - 1, '~');
        if (!diagnostic.expected.empty()) text += " " + diagnostic.expected;
    } else if (!diagnostic.expected.empty()) {
        text += "\n  " + diagnostic.expected;
    }
    return text;
}

namespace {
std::string joined(const std::vector<Diagnostic>& diagnostics) {
    std::string text;
    for (const Diagnostic& d : diagnostics) text += (text.empty() ? "" : "\n") + to_string(d);
    return text;
}
}  // namespace

InputError::InputError(std::vector<Diagnostic> diagnostics)
    : std::runtime_error(joined(diagnostics)), diagnostics_(std::move(diagnostics)) {}

}  // namespace raywalk
