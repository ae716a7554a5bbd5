#pragma once

// pipeline/options: Options by name (octafront/option_table.h): one table of what every option is called, takes,
// means and sets. Takes names and values, leaves Options.
