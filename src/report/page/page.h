#pragma once

// report/page: a mesh and its report as one web page. Takes both, packs the mesh into few bytes, and leaves the text
// of the page; what the page does with them in a browser is in assets/.
