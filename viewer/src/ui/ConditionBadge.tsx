import type { Condition } from '../protocol/types';
import { use_app } from './app';

/** In words for whoever points at it; the reports of runs have the same badges (flexura/report). */
const meanings: Record<Condition, string> = {
  idle: 'Nothing moves, and no tasks run.',
  moving: 'The arm moves to its commanded shape.',
  running: 'Tasks run.',
  done: 'The tasks are done, and nothing has moved since.',
  halted: 'Everything was stopped.',
  failed: 'The tasks failed.',
  unsafe: 'The arm violates a limit, or touches something that it must not touch.',
};

/** The condition of the rig, or of a recorded run at the time that is shown: one badge, the same everywhere. */
export function ConditionBadge() {
  const { viewer } = use_app();
  const said = viewer.condition.value;
  // Nobody knows it while nothing is heard.
  if (!said || viewer.blind) return null;
  const { condition, text } = said;
  return (
    <span class="badge" data-kind={condition} id="condition" role="status" title={text ? `${meanings[condition]} ${text}` : meanings[condition]}>
      {condition.toUpperCase()}
    </span>
  );
}
