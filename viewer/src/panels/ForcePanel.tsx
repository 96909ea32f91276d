import { useSignal } from '@preact/signals';
import { contact_force, contact_normal, contact_slip, contact_stride, push_force, type State } from '../protocol/state';
import type { Hello, PushControl, Range, Scene, Vector3 } from '../protocol/types';
import { size_at } from '../plots/sources';
import { use_app } from '../ui/app';
import { fixed, length_places } from '../ui/format';
import { force_text } from './actuators';
import { NumberField, Slider } from './Slider';

/** Returns whether the program computes forces for this arm. */
export function has_forces(hello: Hello | null): boolean {
  if (!hello) return false;
  const { controls, quantities } = hello;
  return Boolean(controls.push ?? controls.inertia ?? controls.contact)
    || quantities.some(({ name }) => name.startsWith('energy_') || name === 'contact_force');
}

/** Forces on an elastic arm: a push by numbers, energies, and contacts. */
export function ForcePanel() {
  const { viewer } = use_app();
  viewer.tick.value;
  const hello = viewer.hello.value;
  const scene = viewer.scene.value;
  const state = viewer.shown;
  if (!hello || !scene || !state) return <p class="empty">No data received yet.</p>;
  const touches = hello.controls.contact || hello.quantities.some(({ name }) => name === 'contact_force');
  return (
    <>
      {hello.controls.push && !viewer.readonly && <PushFields control={hello.controls.push} state={state} />}
      {state.energy && <Energy energy={state.energy} />}
      {(touches || (state.contacts?.length ?? 0) > 0) && <Contacts contacts={state.contacts ?? new Float32Array(0)} scene={scene} />}
    </>
  );
}

/** Fields for pushing the arm: the keyboard equivalent of dragging, with exact numbers. */
function PushFields({ control, state }: { control: PushControl; state: State }) {
  const { viewer } = use_app();
  const s = useSignal(control.length);
  const force = useSignal<Vector3>([Number((control.most / 20).toPrecision(1)), 0, 0]);
  const { still } = viewer;
  const pushed = Boolean(state.push);
  const again = (): void => {
    if (pushed) viewer.commander.push({ s: s.value, force: force.value });
  };
  const places = length_places(control.length);
  const along: Range = [0, control.length];
  return (
    <fieldset class="section push">
      <legend>Push</legend>
      <p class="quiet">Hold Shift and drag the arm in the view, or enter a push:</p>
      <Slider id="push-s" label="at s" title="Arc length of the pushed point" value={s.value} span={along} reach={along} scale={1} unit="m"
        places={places} disabled={still} change={(value) => { s.value = value; again(); }} />
      <div class="triple">
        {(['X', 'Y', 'Z'] as const).map((axis, i) => (
          <label key={axis}>
            <span aria-hidden="true">{axis}</span>
            <NumberField label={`Force along ${axis}, N`} value={force.value[i]} places={force_places(control.most)} disabled={still}
              change={(value) => { force.value = force.value.map((old, j) => (j === i ? value : old)) as Vector3; again(); }} />
          </label>
        ))}
        <span class="unit">N</span>
      </div>
      <div class="push-row">
        <button type="button" class="button" id="push-apply" title="Pushes with this force" disabled={still}
          onClick={() => viewer.commander.push({ s: s.value, force: force.value })}>Apply</button>
        <button type="button" class="button" id="push-release" title="Ends the push" disabled={still || !pushed} onClick={() => void viewer.commander.release()}>Release</button>
      </div>
      <output class="push-state" aria-live="off">
        {state.push
          ? `Pushed by ${force_text(size_at(state.push, push_force))} at s = ${fixed(state.push[0], places)} m`
          : `No push; ${force_text(control.most)} at most`}
      </output>
    </fieldset>
  );
}

/** Returns the decimal places needed for small fractions of the largest force. */
function force_places(most: number): number {
  return Math.min(5, Math.max(0, 2 - Math.floor(Math.log10(most))));
}

const energies = ['Kinetic', 'Elastic', 'Gravity'];

function Energy({ energy }: { energy: Float32Array }) {
  const total = energy[0] + energy[1] + energy[2];
  const most = Math.max(1e-12, ...Array.from(energy, Math.abs));
  return (
    <fieldset class="section energy" id="energy">
      <legend>Energy</legend>
      {energies.map((name, i) => (
        <div key={name} class="energy-row">
          <span>{name}</span>
          <span class="bar" data-negative={energy[i] < 0} aria-hidden="true"><span style={{ width: `${(100 * Math.abs(energy[i])) / most}%` }} /></span>
          <output aria-live="off">{energy_text(energy[i])}</output>
        </div>
      ))}
      <div class="energy-row"><span>Total</span><span /><output aria-live="off">{energy_text(total)}</output></div>
    </fieldset>
  );
}

/** Formats an energy with a unit prefix that suits its magnitude. */
export function energy_text(joule: number): string {
  const size = Math.abs(joule);
  if (size >= 1) return `${fixed(joule, 2)} J`;
  if (size >= 1e-3) return `${fixed(1e3 * joule, size < 1e-2 ? 2 : 1)} mJ`;
  return size < 5e-9 ? '0 J' : `${fixed(1e6 * joule, 1)} µJ`;
}

const slips = ['', 'slides', 'sticks'];

function Contacts({ contacts, scene }: { contacts: Float32Array; scene: Scene }) {
  const count = contacts.length / contact_stride;
  const places = length_places(scene.arm.sections.reduce((sum, { length }) => sum + length, 0));
  return (
    <fieldset class="section contacts" id="contacts">
      <legend>Contacts</legend>
      {count === 0 ? <p class="quiet" role="status">No contacts.</p> : (
        <table>
          <thead><tr><th scope="col">With</th><th scope="col">s, m</th><th scope="col" title="Normal to the surface">Normal</th><th scope="col">Friction</th></tr></thead>
          <tbody>
            {Array.from({ length: count }, (_, i) => {
              const at = contact_stride * i;
              const normal = contacts[at + contact_normal];
              const size = size_at(contacts, at + contact_force);
              return (
                <tr key={i} title={`Force ${force_text(size)}, friction included`}>
                  <th scope="row">{scene.obstacles[contacts[at]]?.name ?? 'the arm'}</th>
                  <td>{fixed(contacts[at + 1], places)}</td>
                  <td>{force_text(normal || size)}</td>
                  <td data-slip={slips[contacts[at + contact_slip]]}>{slips[contacts[at + contact_slip]] ?? ''}</td>
                </tr>
              );
            })}
          </tbody>
        </table>
      )}
    </fieldset>
  );
}
