// SPDX-License-Identifier: Apache-2.0
import { CustomChart } from 'echarts/charts';
import { echarts } from './echarts';

echarts.use([CustomChart]);

export interface Band {
  x: readonly (number | null)[];
  low: readonly (number | null)[];
  high: readonly (number | null)[];
  colour: string;
}

const FAR = 1e6;

/** What lies between two curves, as one polygon; where a curve has no value it reaches out of the picture. */
export function bandSeries(band: Band, opacity: number) {
  const points = [
    ...band.x.map((x, i) => [x ?? 0, band.high[i] ?? FAR]),
    ...band.x.map((x, i) => [x ?? 0, band.low[i] ?? -FAR]).reverse(),
  ];
  return {
    type: 'custom',
    name: 'band',
    silent: true,
    clip: true,
    data: [[0, 0]],
    renderItem: (params: { dataIndex: number }, api: { coord: (p: number[]) => number[] }) => ({
      type: 'polygon',
      shape: { points: points.map((p) => api.coord(p)) },
      style: { fill: band.colour, opacity: params.dataIndex === 0 ? opacity : 0 },
    }),
  };
}
