// An agent that knows nothing of Octafront but what the server's tools say of themselves, by @modelcontextprotocol/sdk:
// node mcp_agent.mjs OCTAFRONT FOLDER PART.step DECK.inp. It prints each call and answer as a line of JSON. The client checks
// every structured answer by the schema of its tool.
import { Client } from "@modelcontextprotocol/sdk/client/index.js";
import { StdioClientTransport } from "@modelcontextprotocol/sdk/client/stdio.js";

const [octafront, folder, part, deck] = process.argv.slice(2);
const client = new Client({ name: "agent", version: "1.0.0" });
await client.connect(new StdioClientTransport({ command: octafront, args: ["serve", "--mcp", "--folder", folder] }));
const { tools } = await client.listTools();

/** The tool whose description has all of these words. */
const toolFor = (...words) => {
  const found = tools.find((t) => words.every((w) => t.description.toLowerCase().includes(w)));
  if (!found) throw new Error(`no tool says ${words}`);
  return found;
};
/** The name of an option of a tool, by what its description says. */
const optionFor = (tool, ...words) => {
  const all = Object.entries(tool.inputSchema.properties.options.properties);
  const found = all.find(([, o]) => words.every((w) => o.description.toLowerCase().includes(w)));
  if (!found) throw new Error(`no option of ${tool.name} says ${words}`);
  return found[0];
};
const progress = [];
const call = async (tool, args) => {
  const result = await client.callTool({ name: tool.name, arguments: args }, undefined, { onprogress: (p) => progress.push(p), timeout: 120000 });
  console.log(JSON.stringify({ tool: tool.name, arguments: args, answer: result.structuredContent, isError: result.isError ?? false, kinds: result.content.map((c) => c.type) }));
  return result.structuredContent;
};

// What is in the file: its names.
const seen = await call(toolFor("before anything is made", "named faces"), { input: part });
const holes = seen.places.patches.filter((name) => name.includes("hole"));
const wall = seen.places.patches.find((name) => name === "wall");
// What would it take, and is it too much?
const mesher = toolFor("into valid tetrahedra and writes it");
const order = optionFor(mesher, "second order"), size = optionFor(mesher, "edge length");
const planner = toolFor("dry run");
let length = 2;
let plan = await call(planner, { input: part, options: { [size]: length } });
while (plan.dry_run.expected_tets > 10000) plan = await call(planner, { input: part, options: { [size]: (length *= 1.5) } });
// A first try with a name that there is not; the answer says what there is, and the agent puts it right.
const wanted = { [size]: length, [order]: 2, fix: ["bolt holes"], load: `${wall}=-500,0,0` };
const refused = await call(mesher, { input: part, output: deck, options: wanted });
if (refused.status === 0 || !refused.next?.length) throw new Error("a place that there is not is refused, with what to do next");
await call(toolFor("why the last call"), {});
const made = await call(mesher, { input: part, output: deck, options: { ...wanted, fix: holes } });
if (made.status !== 0) throw new Error(made.error.message);
await call(toolFor("solver would warn"), { input: deck, options: { solver: "calculix" } });
const drawn = await call(toolFor("png"), { input: deck, output: "deck.png", options: { highlight: [...holes, wall], size: "800x600" } });
if (drawn.status !== 0) throw new Error(drawn.error.message);
if (progress.length === 0) throw new Error("no progress was told");
await client.close();
