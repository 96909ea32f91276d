// Texts about a campaign.
import type { CampaignMessage } from '../protocol/types';

/** Returns a duration in its two largest units. */
export function duration_text(seconds: number): string {
  const units: [string, number][] = [['d', 86400], ['h', 3600], ['min', 60], ['s', 1]];
  const whole = Math.ceil(seconds);
  const first = units.findIndex(([, size]) => whole >= size);
  if (first < 0) return '0 s';
  const [name, size] = units[first];
  const text = `${Math.floor(whole / size)} ${name}`;
  const next = units[first + 1];
  const rest = next ? Math.floor((whole % size) / next[1]) : 0;
  return rest ? `${text} ${rest} ${next![0]}` : text;
}

export function number_text(value: number): string {
  return String(Number(value.toPrecision(3))).replace('-', '−');
}

/** Returns how far a campaign is, in one sentence. */
export function campaign_state({ reason, rate, left, error }: CampaignMessage): string {
  if (error) return `The results cannot be read: ${error}.`;
  if (reason) return `Complete: ${reason}.`;
  if (rate === null) return 'Not complete.';
  if (!rate) return 'Not complete. No new runs finish.';
  const time = left === null ? '' : `, ${duration_text(left)} left`;
  return `${rate < 1 ? `${number_text(60 * rate)} runs per minute` : `${number_text(rate)} runs per second`}${time}.`;
}
