// XML files, read with the line of everything that is wrong.
#pragma once

#include <filesystem>
#include <memory>
#include <pugixml.hpp>
#include <string>

#include "kernels/vec.h"

namespace vfplan {

// The name of the first element of a text, empty when it is no XML.
std::string root_element(const std::string& head);

class XmlDocument {
public:
    // Throws InputError with line and column.
    XmlDocument(std::string text, const std::filesystem::path& file);

    pugi::xml_node root() const { return document_.document_element(); }
    // Of an attribute or the text of a child element; a finite number. Throws InputError with the
    // line when it is missing or none.
    double number(const pugi::xml_node& node, const char* attribute) const;
    double number(const pugi::xml_node& node, const char* attribute, double otherwise) const;
    double child_number(const pugi::xml_node& node, const char* child) const;
    // An error about an element.
    [[noreturn]] void fail(const pugi::xml_node& node, const std::string& problem) const;

private:
    double parsed(const pugi::xml_node& node, const char* name, const char* value) const;

    std::string text_;
    std::filesystem::path file_;
    pugi::xml_document document_;
};

}  // namespace vfplan
