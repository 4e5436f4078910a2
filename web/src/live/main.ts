// SPDX-License-Identifier: Apache-2.0
import 'virtual:looks.css';
import '../frame/style.css';
import '../frame/table.css';
import '../plot/plot.css';
import './style/shell.css';
import './style/dialogs.css';
import './style/views.css';
import './style/now.css';
import './style/forms.css';
import { App } from './app';
import { element } from '../frame/dom';

void new App(element('app')).start();
