#include "cli/commands.h"
namespace ergocast::cli { int study(const StudyOptions&) { return 0; } }
