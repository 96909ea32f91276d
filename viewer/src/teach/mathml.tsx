// A few MathML elements, supported by browsers and screen readers.
import { createElement, type ComponentChildren, type VNode } from 'preact';

type Children = { children?: ComponentChildren };

const piece = (tag: string) => ({ children }: Children): VNode => createElement(tag, null, children);

export const Math_ = piece('math');
export const I = piece('mi');
export const N = piece('mn');
export const Op = piece('mo');
const Row = piece('mrow');

export function Sub({ of, by }: { of: string; by: string | number }) {
  return createElement('msub', null, <I>{of}</I>, typeof by === 'number' ? <N>{by}</N> : <I>{by}</I>);
}

export function Frac({ over, under }: { over: ComponentChildren; under: ComponentChildren }) {
  return createElement('mfrac', null, <Row>{over}</Row>, <Row>{under}</Row>);
}

/** A function name, upright and followed by a space. */
export function Func({ children }: Children) {
  return createElement('mi', { mathvariant: 'normal', class: 'func' }, children);
}

/** The sum over the sections before. */
export function Sum() {
  return createElement('msub', null, <Op>Σ</Op>, <Row><I>k</I><Op>{'<'}</Op><I>n</I></Row>);
}
