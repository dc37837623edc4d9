// Offices and schools: floors as spaces with portals, in pixels of a traced drawing (Luperto and
// Amigoni's data set).
#pragma once

#include "io/features/drawing.h"
#include "io/features/read_options.h"
#include "io/formats/xml_document.h"

namespace vfplan {

// Spaces become rooms, their borders walls without thickness; a portal, which the file has as a
// place on the border, opens a doorway of 0.9 m around the place that the first of its spaces says,
// moved away from the border's corners. The scale is the file's own. Throws InputError, with the
// line, for what is missing or no number.
Drawing read_office_xml(const XmlDocument& document, const ReadOptions& options);

}  // namespace vfplan
