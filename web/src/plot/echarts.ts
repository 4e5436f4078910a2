// SPDX-License-Identifier: Apache-2.0
// Only the parts of Apache ECharts that the pages draw with.
import { CustomChart, LineChart, ScatterChart } from 'echarts/charts';
import { AriaComponent, DataZoomInsideComponent, GridComponent } from 'echarts/components';
import * as echarts from 'echarts/core';
import { CanvasRenderer, SVGRenderer } from 'echarts/renderers';

echarts.use([AriaComponent, CanvasRenderer, CustomChart, DataZoomInsideComponent, GridComponent, LineChart, ScatterChart, SVGRenderer]);

export { echarts };
