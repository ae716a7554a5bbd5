#pragma once

// base/options: options by name (octafront/option_table.h): one table of what every option is called, takes, may be,
// means and sets. Takes names and values, leaves Options.
