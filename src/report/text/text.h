#pragma once

// report/text: a run's Report as JSON for programs and as a table for people. Takes a Report, leaves text; knows no
// mesh.
