// Texts about a campaign.
import type { CampaignMessage } from '../protocol/types';
import { duration_text } from '../ui/format';

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
