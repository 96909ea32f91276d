// Exports runs as glTF and validates the files with Khronos's gltf-validator: no errors, no warnings.
//
//   node gltf_test.mjs FLEXURA EXAMPLES WORK_DIR
import { execFileSync } from "node:child_process";
import { mkdirSync, readFileSync, rmSync } from "node:fs";
import { join } from "node:path";

const [flexura, examples, work] = process.argv.slice(2);
let validator;
try {
  validator = (await import("gltf-validator")).default;
} catch {
  const isRequired = process.env.FLEXURA_REQUIRE_NODE !== undefined;
  console.log(`${isRequired ? "failed" : "skipped"}: needs \`npm ci\` in tests/node`);
  process.exit(isRequired ? 1 : 0);
}

rmSync(work, { recursive: true, force: true });
mkdirSync(work, { recursive: true });
// A planar arm; cameras that film it; obstacles, which the arm grasps.
const runs = [
  ["01_paper_arm", []],
  ["03_cameras", ["--set", "record.cameras=false", "--set", "task.0.duration=1"]],
  ["13_grasp", ["--set", "record.report=false"]],
];
let failures = 0;
for (const [example, options] of runs) {
  const results = join(work, example), file = join(work, `${example}.glb`);
  execFileSync(flexura, ["run", join(examples, example, "experiment.toml"), "--out", results, ...options]);
  execFileSync(flexura, ["export", results, "--to", "gltf", "--out", file]);
  const report = await validator.validateBytes(new Uint8Array(readFileSync(file)));
  const { numErrors, numWarnings, messages } = report.issues;
  const { animationCount, hasSkins, totalTriangleCount } = report.info;
  console.log(`${example}: ${numErrors} errors, ${numWarnings} warnings, ${totalTriangleCount} triangles`);
  if (numErrors + numWarnings > 0) console.log(JSON.stringify(messages, null, 1));
  if (numErrors + numWarnings > 0 || animationCount !== 1 || !hasSkins) failures += 1;
}
process.exit(failures);
