// SPDX-License-Identifier: Apache-2.0
import './style.css';
import { type Abscissa, COURSE_HEIGHT_PX, CourseChart } from './charts/course_chart';
import { echarts } from './charts/echarts';
import { PathChart } from './charts/path_chart';
import { VIBRATION_HEIGHT_PX, VibrationChart } from './charts/vibration_chart';
import { RUNS, type Report, parseReport } from './data';
import { element, onChoice } from './dom';
import { legend, renderPage } from './page';
import { type Plane, boundingBox } from './path';
import { errorClasses } from './scale';
import { onSchemeChange, theme } from './theme';

function largestError(report: Report): number {
  let largest = 0;
  for (const run of RUNS) {
    const { contour_error_um, cutting } = report[run].trace;
    contour_error_um.forEach((e, i) => {
      if (e !== null && cutting[i] === 1) {
        largest = Math.max(largest, Math.abs(e));
      }
    });
  }
  return largest;
}

/** Of a cut that was simulated with its vibration. */
function vibrationChart(report: Report): VibrationChart | undefined {
  if (!report.without.vibration) {
    return undefined;
  }
  element('vibration').style.height = `${VIBRATION_HEIGHT_PX}px`;
  return new VibrationChart(element('vibration'), report);
}

function show(report: Report): void {
  document.title = `${report.program} – Steadyrest report`;
  renderPage(element('report'), report);
  element('course').style.height = `${COURSE_HEIGHT_PX}px`;
  const traces = RUNS.map((run) => report[run].trace);
  const paths = [
    new PathChart(element('path-without'), report.without.trace, 'Without the layer'),
    new PathChart(element('path-with'), report.with.trace, 'With the layer'),
  ];
  echarts.connect(paths.map((p) => p.chart));
  const course = new CourseChart(element('course'), report);
  const vibration = vibrationChart(report);
  const largest_um = largestError(report);
  const state = { plane: 'xy' as Plane, abscissa: 'time_s' as Abscissa, printing: false };

  const drawPaths = () => {
    const now = theme(state.printing);
    const classes = errorClasses(report.limit_um, largest_um, now.scheme);
    element('legend').innerHTML = legend(classes);
    const box = boundingBox(traces, state.plane);
    paths.forEach((path) => path.draw(state.plane, box, classes, now));
  };
  const drawCourse = () => course.draw(state.abscissa, theme(state.printing));
  const drawAll = () => {
    drawPaths();
    drawCourse();
    vibration?.draw(theme(state.printing));
  };
  const print = (printing: boolean) => {
    state.printing = printing;
    document.documentElement.classList.toggle('printing', printing);
    drawAll();
  };

  onChoice('plane', (value) => {
    state.plane = value as Plane;
    drawPaths();
  });
  onChoice('abscissa', (value) => {
    state.abscissa = value as Abscissa;
    drawCourse();
  });
  element('reset-view').addEventListener('click', () => paths.forEach((p) => p.resetView()));
  onSchemeChange(drawAll);
  window.addEventListener('beforeprint', () => print(true));
  window.addEventListener('afterprint', () => print(false));
  let width = window.innerWidth;
  window.addEventListener('resize', () => {
    if (window.innerWidth !== width && !state.printing) {
      width = window.innerWidth;
      drawAll();
    }
  });
  drawAll();
  Object.assign(window, { steadyrestCharts: { paths: paths.map((p) => p.chart), course: course.chart, vibration: vibration?.chart } });
}

const report = parseReport(element('report-data').textContent ?? '');
if (typeof report === 'string') {
  element('report').innerHTML = `<p class="none" id="no-data">${report}</p>`;
} else {
  show(report);
}
