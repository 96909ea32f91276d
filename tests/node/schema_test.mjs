// Validates experiment files with taplo, the validator of TOML editors, against the schema that the program prints.
// Those of the examples, of a results folder, and one that includes its arm must be valid. Errors of invalid files must
// be located correctly.
//   node schema_test.mjs FLEXURA EXAMPLES WORK_DIR
// Exit status 0: success; 1: failure. Prints "skipped:" on stdout if taplo is not installed (a failure if
// FLEXURA_REQUIRE_NODE is set).
import assert from "node:assert/strict";
import { execFileSync, spawnSync } from "node:child_process";
import { existsSync, mkdirSync, readFileSync, readdirSync, rmSync, writeFileSync } from "node:fs";
import { join, resolve } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";

const [flexura, examples, work] = process.argv.slice(2).map((path) => resolve(path));
const taplo = fileURLToPath(new URL("node_modules/.bin/taplo", import.meta.url));
if (!existsSync(taplo)) {
  const isRequired = process.env.FLEXURA_REQUIRE_NODE !== undefined;
  console.log(`${isRequired ? "failed" : "skipped"}: needs \`npm ci\` in tests/node`);
  process.exit(isRequired ? 1 : 0);
}

rmSync(work, { recursive: true, force: true });
mkdirSync(work, { recursive: true });
const schema = join(work, "schema.json");
writeFileSync(schema, execFileSync(flexura, ["schema"]));

/** What taplo says of files, and whether it takes them. */
function judge(files) {
  const args = ["check", "--schema", pathToFileURL(schema).href, ...files];
  const { status, stderr, error } = spawnSync(taplo, args, { cwd: work, encoding: "utf8", timeout: 60000 });
  assert.equal(error, undefined);
  return { isGood: status === 0, said: stderr };
}

function written(name, text) {
  const file = join(work, name);
  writeFileSync(file, text);
  return file;
}

const paper = join(examples, "01_paper_arm", "experiment.toml");
const text = readFileSync(paper, "utf8");
execFileSync(flexura, ["run", paper, "--out", join(work, "results")]);
const good = readdirSync(examples, { withFileTypes: true })
  .filter((entry) => entry.isDirectory())
  .map((entry) => join(examples, entry.name, "experiment.toml"));
assert.ok(good.length >= 4);
good.push(join(work, "results", "experiment.toml"));
good.push(written("with_others.toml", 'include = ["arm.toml"]\n[[task]]\nkind = "hold"\nduration = 1\n'));
const all = judge(good);
assert.ok(all.isGood, all.said);

const bad = [
  ["neither arm nor include", "seed = 1\n", '{"seed":1}'],
  ["kind", text.replace('"planar"', '"plane"'), "plane"],
  ["negative radius", text.replace("radius = 0.1", "radius = -0.1"), "-0.1"],
  ["misspelt key", text.replace("length = 2.0", "lenght = 2.0"), "lenght"],
  ["text for a number", text.replace("length = 2.0", 'length = "2"'), "2"],
  ["wrong unit", text.replace("length = 2.0", "length_deg = 2.0"), "length"],
];
for (const [name, document, word] of bad) {
  assert.notEqual(document, text, name);
  const { isGood, said } = judge([written("bad.toml", document)]);
  assert.ok(!isGood && said.includes("bad.toml") && said.includes(word), `${name}: ${said}`);
}
console.log(`${good.length} good files, ${bad.length} bad ones`);
