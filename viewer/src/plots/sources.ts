// Plot sources of a live rig, from the states that the page remembers.
import {
  actuator_force, actuator_stride, camera_pan, camera_stride, camera_tilt, contact_force, contact_stride, push_force, sample_stride, type State,
} from '../protocol/state';
import type { Hello, Scene } from '../protocol/types';

export interface Source {
  id: string;
  label: string;
  unit: string;
  names: string[];
  /** Note of a source that shows only a part of a group. */
  part?: string;
  /** Value of series i in a state; null if missing. */
  value(state: State, i: number): number | null;
}

const degree = 180 / Math.PI;

export function live_sources(hello: Hello, scene: Scene): Source[] {
  const sections = scene.arm.sections.length;
  const planar = scene.arm.kind === 'planar';
  const { actuators } = hello.controls;
  // If tendons pull an arm that also yields to its weight, the bends are commanded values.
  const bends = actuators ? 'Bends, commanded' : 'Bends';
  const sources: Source[] = [
    {
      id: 'tip', label: 'Tip', unit: 'm', names: ['x', 'y', 'z'],
      value: ({ samples }, i) => samples[samples.length - sample_stride + 1 + i],
    },
    planar
      ? {
          id: 'bends', label: bends, unit: '°', names: numbered('section', sections),
          value: ({ bends }, i) => bends[2 * i] * degree,
        }
      : {
          id: 'bends', label: bends, unit: '°',
          names: Array.from({ length: 2 * sections }, (_, i) => `${(i >> 1) + 1}${'xy'[i & 1]}`),
          value: ({ bends }, i) => bends[i] * degree,
        },
  ];
  if (scene.arm.sections.some(({ stretch }) => stretch[1] > stretch[0])) {
    sources.push({
      id: 'stretch', label: 'Stretch', unit: '%', names: numbered('section', sections),
      value: ({ stretches }, i) => stretches[i] * 100,
    });
  }
  if (hello.controls.tendons) {
    sources.push({
      id: 'tendons', label: 'Tendons', unit: 'mm', names: numbered('tendon', hello.controls.tendons.length),
      value: ({ displacements }, i) => displacements[i] * 1000,
    });
  }
  if (actuators) {
    const names = actuators.map(({ name }) => name.toLowerCase());
    sources.push({
      id: 'tendons', label: 'Tendons, pulled in', unit: 'mm', names, value: (state, i) => state.actuators[actuator_stride * i] * 1000,
    }, {
      id: 'tensions', label: 'Tensions', unit: 'N', names, value: (state, i) => state.actuators[actuator_stride * i + actuator_force],
    });
  }
  if (hello.controls.inertia) {
    sources.push({
      id: 'energy', label: 'Energy', unit: 'J', names: ['kinetic', 'elastic', 'gravity', 'total'],
      value: ({ energy }, i) => {
        if (!energy) return null;
        return i < 3 ? energy[i] : energy[0] + energy[1] + energy[2];
      },
    });
  }
  if (hello.controls.push) {
    sources.push({ id: 'push', label: 'Push', unit: 'N', names: ['force'], value: ({ push }) => (push ? size_at(push, push_force) : 0) });
  }
  if (hello.controls.contact) {
    sources.push({
      id: 'contacts', label: 'Contact forces', unit: 'N', names: ['sum'],
      value: ({ contacts }) => {
        let sum = 0;
        for (let i = 0; contacts && i < contacts.length; i += contact_stride) sum += size_at(contacts, i + contact_force);
        return sum;
      },
    });
  }
  if (scene.cameras.length) {
    sources.push({
      id: 'heads', label: 'Pan and tilt', unit: '°',
      names: scene.cameras.flatMap(({ name }) => [`${name} pan`, `${name} tilt`]),
      value: ({ cameras }, i) => cameras[(i >> 1) * camera_stride + (i & 1 ? camera_tilt : camera_pan)] * degree,
    });
  }
  if (hello.controls.tasks.some(({ kind }) => kind === 'servo')) {
    sources.push({
      id: servo_group, label: readable(servo_group), unit: '%', names: short_names(servo_names),
      value: ({ extras }, i) => extras?.values[servo_names[i]] ?? null,
    });
  }
  return sources.flatMap(in_parts);
}

/** Returns the norm of the 3-vector that starts at `at`. */
export function size_at(numbers: ArrayLike<number>, at: number): number {
  return Math.hypot(numbers[at], numbers[at + 1], numbers[at + 2]);
}

/** Group name of a servo's errors in recordings, as shares of the arm's length. */
const servo_group = 'servo_error';
const servo_names = ['servo_rms', 'servo_tip', 'servo_true_rms', 'servo_true_tip'];

/** A plot over the arm's length instead of time. */
export const along_option = { id: 'along', label: 'Errors along the arm', unit: '' };

/** Returns whether such a plot is available. */
export function can_be_along({ mode, controls, quantities }: Hello): boolean {
  return mode === 'live' ? controls.tasks.some(({ kind }) => kind === 'servo') : quantities.some(({ group }) => group === servo_group);
}

/** Splits a source into groups of series that can be distinguished. */
function in_parts(source: Source): Source[] {
  const { id, label, names, value } = source;
  const parts = Math.ceil(names.length / most_in_group);
  if (parts < 2) return [source];
  return Array.from({ length: parts }, (_, i) => {
    const from = i * most_in_group;
    const some = names.slice(from, from + most_in_group);
    return {
      ...source, id: part_id(id, i), label: part_label(label, i), names: some, part: part_text(some.length, names.length, label, i, parts),
      value: (state: State, j: number) => value(state, from + j),
    };
  });
}

function part_id(id: string, i: number): string {
  return i ? `${id}+${i}` : id;
}

function part_label(label: string, i: number): string {
  if (!i) return label;
  return i === 1 ? `${label} (more)` : `${label} (more ${i})`;
}

function part_text(shown: number, all: number, label: string, i: number, parts: number): string {
  return `${shown} of ${all}; others: “${part_label(label, i + 1 < parts ? i + 1 : 0)}”`;
}

function numbered(word: string, count: number): string[] {
  return Array.from({ length: count }, (_, i) => `${word} ${i + 1}`);
}

export interface Group {
  id: string;
  label: string;
  unit: string;
  names: string[];
  part?: string;
}

/** Returns the groups of a recording with display factors; angles are in degrees. */
export function shown_groups({ quantities }: Hello): (Group & { factor: number })[] {
  return groups_of(quantities).map((group) =>
    group.unit === 'rad' ? { ...group, unit: '°', factor: 180 / Math.PI } : { ...group, factor: 1 },
  );
}

/** Maximum number of series that can be distinguished by colour and in the legend. */
export const most_in_group = 9;

/** Groups a recording's quantities by their group, or by the common part of their names. */
export function groups_of(quantities: Hello['quantities']): Group[] {
  const groups = new Map<string, Group>();
  for (const { name, unit, group: told } of quantities) {
    const stem = told ?? (name.replace(/[\s._/-]?[\[(]?\d+[\])]?/g, '').replace(/[._/ -](x|y|z)$/, '') || name);
    const id = `${stem} ${unit}`;
    const group = groups.get(id) ?? { id, label: readable(stem), unit, names: [] };
    groups.set(id, group);
    group.names.push(name);
  }
  return [...groups.values()].flatMap(({ id, label, unit, names }) => {
    const parts = Math.ceil(names.length / most_in_group);
    return Array.from({ length: parts }, (_, i) => {
      const some = names.slice(i * most_in_group, (i + 1) * most_in_group);
      const part = parts > 1 ? part_text(some.length, names.length, label, i, parts) : undefined;
      return { id: part_id(id, i), label: part_label(label, i), unit, names: some, part };
    });
  });
}

/** Returns a quantity's name in readable form. */
export function readable(name: string): string {
  const words = name.replace(/_/g, ' ');
  return words.charAt(0).toUpperCase() + words.slice(1);
}

/** Returns the distinguishing parts of the names of a group, for example the last letters of tip_x, tip_y and tip_z. */
export function short_names(names: string[]): string[] {
  if (names.length < 2) return names.map(readable);
  let common = 0;
  while (common < names[0].length && names.every((name) => name[common] === names[0][common])) ++common;
  const short = names.map((name) => name.slice(common).replace(/^[\s._/[(-]+|[\])]+/g, '').replace(/_/g, ' '));
  return short.every(Boolean) ? short : names.map(readable);
}
