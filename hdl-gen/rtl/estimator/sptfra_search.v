// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Search along the line: t in [-1, 1], the midpoint of the level set of B(t) = sum max(0, alpha_i + t beta_i).
//
// B is Condition 1 (Eq. 20), convex and piecewise linear. Bisection on the sign of its slope finds the minimum.
// Bisection on its value finds both ends of {t : B(t) <= B_min + 2^-9 sum |b|}. Each finds a distance of 17 bits, the
// highest bit first: of the minimum from -1, of the ends from the minimum. With POINTS = 3 a round evaluates both
// candidates of the next bisection too, and finds two bits of the same answer. CELLS cells with up to CELL_ELEMENTS
// taxels each work side by side. t has 16 fraction bits.
//
// Latency from start to done: 6n + 2d + 9 + R(n + d + 1) + (R - 1) max(2n, n + d + 1) cycles, n being CELL_ELEMENTS.
// R: 17 rounds, or 9 with three points. d: cycles from a round's last taxel to its decision. Interval: the same.

`default_nettype none

module sptfra_search #(
    // Taxels along x
    parameter integer COLUMNS = 10,
    // Taxels along y
    parameter integer ROWS = 10,
    // Taxels that arrive at a time: 4, the images of an orbit, or 1
    parameter integer CHANNELS = 4,
    // Bits of u_q
    parameter integer DATA_BITS = 27,
    // Bits of the number of an orbit or taxel
    parameter integer ROW_WIDTH = 5,
    // Cells, as many for each channel
    parameter integer CELLS = 16,
    // Taxels of a cell, a power of two
    parameter integer CELL_ELEMENTS = 8,
    // Points of a round: 1, or 3
    parameter integer POINTS = 1,
    // Left shift (negative: right) that turns sum |b| into the level above the least B
    parameter integer LEVEL_SHIFT = -1,
    // From start to done, checked in simulation; 0: unchecked
    parameter integer EXPECTED_LATENCY = 0
) (
    input  wire clock,
    input  wire reset,
    // u_q, channel 0 in the lowest bits
    input  wire [2:0] u_valid,
    input  wire [ROW_WIDTH-1:0] u_row,
    input  wire [CHANNELS*DATA_BITS-1:0] u_values,
    input  wire fill_bank, // of the cells' memories
    input  wire search_bank,
    // Start, with the line held from the next cycle on
    input  wire start,
    input  wire x_is_free,
    input  wire signed [17:0] next_c0, // c0 of the next cycle, with start
    input  wire signed [17:0] c0,
    input  wire signed [17:0] c1,
    input  wire [39:0] stress_sum,
    // Result, held until the next one
    output reg  done, // one cycle
    output reg  signed [17:0] t,
    output reg  at_bound, // the minimum lies at an end of [-1, 1]
    output reg  saturated
);

    localparam integer SEARCH_STEPS = 17; // bits of a distance
    localparam [SEARCH_STEPS-1:0] NONE = 0;
    localparam integer ELEMENT_WIDTH = (CELL_ELEMENTS <= 2) ? 1 : $clog2(CELL_ELEMENTS);
    localparam integer LAST_ELEMENT = CELL_ELEMENTS - 1;
    // From the last taxel's address of an evaluation to the decision: the cell, the tree, the decision
    localparam integer DECISION_CYCLES = ((POINTS == 3) ? 6 : 5) + $clog2(CELLS);
    // The other end is read while one waits for its decision; of so many taxels that it is known when they are over
    localparam [0:0] KNOWN_IN_TIME = (LAST_ELEMENT > DECISION_CYCLES);
    localparam signed [17:0] ONE = 18'sd65536;
    localparam integer LEVEL_LEFT = (LEVEL_SHIFT > 0) ? LEVEL_SHIFT : 0;
    localparam integer LEVEL_RIGHT = (LEVEL_SHIFT < 0) ? -LEVEL_SHIFT : 0;

    localparam [2:0] IDLE = 3'd0, ALPHA = 3'd1, BETA = 3'd2, SETTLE = 3'd3, SLOPE = 3'd4, FLOOR = 3'd5, LEVEL = 3'd6,
        FINISH = 3'd7;

    reg [2:0] state;
    reg [ELEMENT_WIDTH-1:0] element;
    reg second; // of a pair of evaluations
    reg reading;
    reg resume; // reading goes on in the next cycle
    reg [1:0] wait_count;

    // ---- Distances: of the minimum from -1, then of the left end from the minimum; of the right end
    wire [SEARCH_STEPS-1:0] left, left_half, left_near, left_far;
    wire [SEARCH_STEPS-1:0] right, right_half, right_near, right_far;
    wire left_last, right_last; // the last round
    wire [2:0] left_keep, right_keep;
    wire left_over, right_over;
    wire restart; // both distances
    reg signed [17:0] lowest; // t of the least B
    wire signed [17:0] low = {1'b0, left} - ONE;
    wire signed [17:0] high = low + 18'sd1;
    wire signed [18:0] ends_sum = {lowest, 1'b0} + {2'd0, right} - {2'd0, left};

    // The ends lie within (-1, 1)
    sptfra_search_distance #(.BITS(SEARCH_STEPS), .POINTS(POINTS)) left_distance (
        .clock     (clock),
        .restart   (restart),
        .over      (left_over),
        .keep      (left_keep),
        .unbounded (state == SLOPE),
        .room      (lowest + ONE),
        .distance  (left),
        .last      (left_last),
        .half      (left_half),
        .below     (left_near),
        .above     (left_far)
    );

    sptfra_search_distance #(.BITS(SEARCH_STEPS), .POINTS(POINTS)) right_distance (
        .clock     (clock),
        .restart   (restart),
        .over      (right_over),
        .keep      (right_keep),
        .unbounded (1'b0),
        .room      (ONE - lowest),
        .distance  (right),
        .last      (right_last),
        .half      (right_half),
        .below     (right_near),
        .above     (right_far)
    );

    // Of a round's points the cells take the one with the largest t
    wire signed [17:0] slope_t = {1'b0, left_far} - ONE;
    wire signed [17:0] left_t = lowest - {1'b0, left_near};
    wire signed [17:0] right_t = lowest + {1'b0, right_far};

    // The factor is a register, which goes all the way to the cells' multipliers: it is chosen for the next cycle
    wire pair = (state == FLOOR) || (state == LEVEL);
    reg raise; // floor_low is B_min: the level follows
    wire last_element;
    wire next_second = last_element ? pair && !second : second;
    reg signed [17:0] factor;

    always @(posedge clock) begin
        case (state)
            IDLE: factor <= next_c0;
            ALPHA: factor <= last_element ? c1 : c0;
            BETA: factor <= c1;
            FLOOR: factor <= raise ? left_t : next_second ? high : low;
            LEVEL: factor <= next_second ? right_t : left_t;
            default: factor <= slope_t;
        endcase
    end

    // ---- Cells
    reg signed [47:0] level;
    wire [48*POINTS-1:0] totals; // B or its slope at t, t - h, t - 2 h
    wire [POINTS-1:0] fits_level; // B <= level
    wire [SEARCH_STEPS-1:0] half = ((state == LEVEL) && second) ? right_half : left_half; // h = 2^(15 - 2 round)
    wire [2:0] round = {half[7] || half[5] || half[3] || half[1], half[11] || half[9] || half[3] || half[1],
        half[13] || half[9] || half[5] || half[1]};
    wire cells_saturated;

    sptfra_search_cells #(
        .COLUMNS       (COLUMNS),
        .ROWS          (ROWS),
        .CHANNELS      (CHANNELS),
        .DATA_BITS     (DATA_BITS),
        .ROW_WIDTH     (ROW_WIDTH),
        .CELLS         (CELLS),
        .CELL_ELEMENTS (CELL_ELEMENTS),
        .ELEMENT_WIDTH (ELEMENT_WIDTH),
        .POINTS        (POINTS)
    ) cells (
        .clock      (clock),
        .reset      (reset),
        .u_valid    (u_valid),
        .u_row      (u_row),
        .u_values   (u_values),
        .fill_bank  (fill_bank),
        .read       (reading),
        .bank       (search_bank),
        .element    (element),
        .alpha_pass (state == ALPHA),
        .beta_pass  (state == BETA),
        .x_is_free  (x_is_free),
        .want_slope (state == SLOPE),
        .factor     (factor),
        .round      (round),
        .level      (level),
        .totals     (totals),
        .fits_level (fits_level),
        .saturated  (cells_saturated)
    );

    // ---- Decisions
    assign last_element = reading && (element == LAST_ELEMENT[ELEMENT_WIDTH-1:0]);
    reg [DECISION_CYCLES-1:1] ends; // of an evaluation; index k: k cycles after its last taxel's address
    reg [DECISION_CYCLES-1:1] seconds;
    reg first_over; // the first evaluation of a pair
    reg step_over; // the only one, or the second
    reg signed [47:0] floor_low; // B at low, then the lower of both ends
    reg signed [47:0] floor_high; // B at high
    reg compare; // both are there
    reg compared;
    reg high_is_lower;
    wire [47:0] margin = ({8'd0, stress_sum} << LEVEL_LEFT) >> LEVEL_RIGHT;

    // Bits of a round: of the middle point, then of the one behind it or before it
    wire [2:0] falls; // the slope: far, middle, near
    wire [2:0] left_fits;
    wire [2:0] right_fits;

    if ((POINTS != 1) && (POINTS != 3)) begin : gen_check_points
        sptfra_error_points_must_be_1_or_3 invalid ();
    end
    if (POINTS == 3) begin : gen_three
        // Of a round with one bit all is at t
        assign falls = left_last ? {3{totals[47]}} : {totals[47], totals[95], totals[143]};
        assign left_fits = left_last ? {3{fits_level[0]}} : {fits_level[2], fits_level[1], fits_level[0]};
        assign right_fits = right_last ? {3{fits_level[0]}} : {fits_level[0], fits_level[1], fits_level[2]};
    end else begin : gen_one
        assign falls = {3{totals[47]}};
        assign left_fits = {3{fits_level[0]}};
        assign right_fits = {3{fits_level[0]}};
    end

    assign left_keep = (state == SLOPE) ? falls : left_fits;
    assign right_keep = right_fits;
    assign left_over = (state == SLOPE) ? step_over : (state == LEVEL) && first_over;
    assign right_over = (state == LEVEL) && step_over;
    assign restart = (state == ALPHA) || ((state == FLOOR) && compared);

    always @(posedge clock) begin
        ends <= {ends[DECISION_CYCLES-2:1], last_element && (state != ALPHA) && (state != BETA)};
        seconds <= {seconds[DECISION_CYCLES-2:1], second};
        first_over <= ends[DECISION_CYCLES-1] && pair && !seconds[DECISION_CYCLES-1];
        step_over <= ends[DECISION_CYCLES-1] && (!pair || seconds[DECISION_CYCLES-1]);
        if (reset) begin
            ends <= {(DECISION_CYCLES - 1){1'b0}};
            first_over <= 1'b0;
            step_over <= 1'b0;
        end
    end

    // ---- Sequence
    always @(posedge clock) begin
        done <= 1'b0;
        if (reading) begin
            element <= last_element ? {ELEMENT_WIDTH{1'b0}} : element + 1'b1;
            if (last_element) begin
                second <= pair && !second;
                reading <= (pair && !second) || (KNOWN_IN_TIME && (state == LEVEL) && !right_last);
            end
        end
        if (resume) begin
            {reading, resume} <= 2'b10;
        end
        wait_count <= wait_count + 2'd1;
        if (cells_saturated) begin
            saturated <= 1'b1;
        end
        case (state)
            IDLE: begin
                element <= {ELEMENT_WIDTH{1'b0}};
                second <= 1'b0;
                if (start) begin
                    saturated <= 1'b0;
                    reading <= 1'b1;
                    state <= ALPHA;
                end
            end
            ALPHA: begin
                if (last_element) begin
                    reading <= 1'b1;
                    state <= BETA;
                end
            end
            BETA: begin
                wait_count <= 2'd0;
                if (last_element) begin
                    state <= SETTLE;
                end
            end
            SETTLE: begin
                if (wait_count == 2'd3) begin
                    reading <= 1'b1;
                    state <= SLOPE;
                end
            end
            SLOPE: begin
                if (step_over) begin
                    resume <= 1'b1;
                    if (left_last) begin
                        state <= FLOOR;
                    end
                end
            end
            FLOOR: begin
                raise <= 1'b0;
                if (raise) begin
                    level <= floor_low + margin;
                    reading <= 1'b1;
                    state <= LEVEL;
                end
                if (first_over) begin
                    floor_low <= totals[47:0];
                end
                compare <= step_over;
                compared <= compare;
                high_is_lower <= (floor_high < floor_low);
                if (step_over) begin
                    floor_high <= totals[47:0];
                end
                if (compared) begin
                    lowest <= high_is_lower ? high : low;
                    at_bound <= (left == NONE) || (left == ~NONE);
                    floor_low <= high_is_lower ? floor_high : floor_low;
                    raise <= 1'b1;
                end
            end
            LEVEL: begin
                if (first_over) begin
                    resume <= !KNOWN_IN_TIME && !left_last;
                end
                if (step_over && right_last) begin
                    state <= FINISH;
                end
            end
            default: begin
                t <= ends_sum[18:1];
                done <= 1'b1;
                state <= IDLE;
            end
        endcase
        if (reset) begin
            state <= IDLE;
            reading <= 1'b0;
            resume <= 1'b0;
            compare <= 1'b0;
            compared <= 1'b0;
            raise <= 1'b0;
            done <= 1'b0;
            saturated <= 1'b0;
        end
    end

    sptfra_check_latency #(
        .CYCLES (EXPECTED_LATENCY)
    ) check_latency (
        .clock (clock),
        .reset (reset),
        .start (start),
        .done  (done)
    );

    // Of a slope its sign; h is 0 with one point
    wire _unused = &{1'b0, totals, ends_sum[0], half, right_near};

endmodule

`default_nettype wire
