// SPDX-License-Identifier: Apache-2.0
import '../frame/style.css';

document.title = 'Steadyrest';
