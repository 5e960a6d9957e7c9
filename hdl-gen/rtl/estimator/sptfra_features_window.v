// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// A window of the taxels' shares around the contact, folded into parity components: the words of the network.
//
// The window has 2 HALF_X + 1 by 2 HALF_Y + 1 taxels about the taxel nearest to the centroid of the compression. A
// word of four components for each of its places comes first. Then follow 1, mu_x, mu_y and the centroid's offset from
// that taxel in x and y. All have 19 fraction bits. From start to the first of them: 11 cycles; then one a cycle, the
// last with done.

`default_nettype none

module sptfra_features_window #(
    // Taxels along x
    parameter integer COLUMNS = 10,
    // Taxels along y
    parameter integer ROWS = 10,
    // Bits of the number of an orbit
    parameter integer ROW_WIDTH = 5,
    // Taxels on either side of the window's middle
    parameter integer HALF_X = 4,
    parameter integer HALF_Y = 4,
    // Words of inputs
    parameter integer LENGTH = 27,
    // Bits of a word's number
    parameter integer WORD_WIDTH = 5
) (
    input  wire clock,
    input  wire reset,
    // Shares of an orbit's taxels, image 0 in the lowest bits
    input  wire share_valid,
    input  wire [ROW_WIDTH-1:0] share_orbit,
    input  wire [4*25-1:0] shares,
    // All shares are in; the centroid is there, and held
    input  wire start,
    input  wire [21:0] centroid_x, // 16 fraction bits
    input  wire [21:0] centroid_y,
    input  wire signed [17:0] mu_x,
    input  wire signed [17:0] mu_y,
    // Inputs of the network
    output reg  input_valid,
    output reg  input_first, // with the first of them
    output reg  [WORD_WIDTH-1:0] input_word,
    output reg  [4*27-1:0] input_values, // component 0 in the lowest bits
    output reg  done // one cycle, with the last of them
);

    localparam integer STRESS_BITS = 25;
    localparam integer INPUT_BITS = STRESS_BITS + 2;
    localparam integer FINER = 3; // bits by which an input is finer than a friction component
    localparam [INPUT_BITS-1:0] INPUT_ONE = 27'd524288;
    // From here on a centre belongs to the next taxel, 16 fraction bits: a little more than half, for ties
    localparam [21:0] CENTRE_HALF = 22'd32832;
    localparam integer PX_WIDTH = (HALF_X < 2) ? 1 : $clog2(HALF_X + 1);
    localparam integer PY_WIDTH = (HALF_Y < 2) ? 1 : $clog2(HALF_Y + 1);
    localparam integer PLACES = (HALF_X + 1) * (HALF_Y + 1);
    localparam integer LAST_OF_WINDOW = PLACES - 1;
    localparam integer LAST_BUT_ONE = LENGTH - 2;
    localparam integer ORBIT_COLUMNS = (COLUMNS + 1) / 2;
    localparam integer ORBIT_ROWS = (ROWS + 1) / 2;
    localparam integer SEEN_DEPTH = (ORBIT_COLUMNS * ORBIT_ROWS > 8) ? ORBIT_COLUMNS * ORBIT_ROWS : 8;
    localparam integer LAST_COLUMN = COLUMNS - 1;
    localparam integer LAST_ROW = ROWS - 1;
    localparam [8:0] GRID_COLUMNS = COLUMNS[8:0];
    localparam [8:0] GRID_ROWS = ROWS[8:0];

    localparam [2:0] IDLE = 3'd0, CENTRE = 3'd1, WINDOW = 3'd2, FLUSH = 3'd3, REMAINING = 3'd4;

    if (LENGTH < PLACES + 2) begin : gen_check
        sptfra_error_the_words_do_not_hold_the_window invalid ();
    end

    reg [2:0] state;
    reg [2:0] wait_count;

    // ---- The taxel next to the centre, and what is left of a pitch
    wire [21:0] shifted_x = centroid_x + CENTRE_HALF;
    wire [21:0] shifted_y = centroid_y + CENTRE_HALF;
    reg signed [9:0] centre_x;
    reg signed [9:0] centre_y;
    reg signed [17:0] left_x;
    reg signed [17:0] left_y;

    always @(posedge clock) begin
        centre_x <= {4'd0, shifted_x[21:16]};
        centre_y <= {4'd0, shifted_y[21:16]};
        left_x <= {2'd0, centroid_x[15:0]} - {1'b0, centre_x[0] ^ centroid_x[16], 16'd0};
        left_y <= {2'd0, centroid_y[15:0]} - {1'b0, centre_y[0] ^ centroid_y[16], 16'd0};
    end

    // ---- Places of a quarter of the window, and where their images stand; index k: k cycles after the counters
    reg [PX_WIDTH-1:0] place_x;
    reg [PY_WIDTH-1:0] place_y;
    wire reading = (state == WINDOW);
    wire last_place_x = (place_x == HALF_X[PX_WIDTH-1:0]);
    wire last_place = last_place_x && (place_y == HALF_Y[PY_WIDTH-1:0]);
    wire signed [9:0] distance_x = { {(10 - PX_WIDTH){1'b0}}, place_x};
    wire signed [9:0] distance_y = { {(10 - PY_WIDTH){1'b0}}, place_y};
    reg [7:1] there; // a place

    always @(posedge clock) begin
        if (reading) begin
            place_x <= last_place_x ? {PX_WIDTH{1'b0}} : place_x + 1'b1;
            place_y <= last_place_x ? place_y + 1'b1 : place_y;
        end else begin
            place_x <= {PX_WIDTH{1'b0}};
            place_y <= {PY_WIDTH{1'b0}};
        end
        there <= {there[6:1], reading};
        if (reset) begin
            there <= 7'd0;
        end
    end

    // Along each axis, the side that grows and the mirrored one. Each has the orbit's column or row, whether the taxel
    // is in the far half of the grid, and whether it is one at all. In the middle of the window only the first counts
    wire [ROW_WIDTH-1:0] column_2 [0:1];
    wire [ROW_WIDTH-1:0] row_2 [0:1];
    wire [1:0] far_x_2;
    wire [1:0] far_y_2;
    wire [1:0] inside_x_2;
    wire [1:0] inside_y_2;

    genvar side;

    for (side = 0; side < 2; side = side + 1) begin : gen_sides
        reg signed [9:0] at_x;
        reg signed [9:0] at_y;
        reg counts_x;
        reg counts_y;
        wire in_far_x = (at_x[8:0] >= ORBIT_COLUMNS[8:0]);
        wire in_far_y = (at_y[8:0] >= ORBIT_ROWS[8:0]);
        reg [9:0] column;
        reg [9:0] row;
        reg far_x;
        reg far_y;
        reg inside_x;
        reg inside_y;

        always @(posedge clock) begin
            at_x <= (side == 0) ? centre_x + distance_x : centre_x - distance_x;
            at_y <= (side == 0) ? centre_y + distance_y : centre_y - distance_y;
            counts_x <= (side == 0) || (place_x != {PX_WIDTH{1'b0}});
            counts_y <= (side == 0) || (place_y != {PY_WIDTH{1'b0}});
            column <= in_far_x ? LAST_COLUMN[9:0] - at_x : at_x;
            row <= in_far_y ? LAST_ROW[9:0] - at_y : at_y;
            far_x <= in_far_x;
            far_y <= in_far_y;
            inside_x <= counts_x && !at_x[9] && (at_x[8:0] < GRID_COLUMNS);
            inside_y <= counts_y && !at_y[9] && (at_y[8:0] < GRID_ROWS);
        end

        assign column_2[side] = column[ROW_WIDTH-1:0];
        assign row_2[side] = row[ROW_WIDTH-1:0];
        assign far_x_2[side] = far_x;
        assign far_y_2[side] = far_y;
        assign inside_x_2[side] = inside_x;
        assign inside_y_2[side] = inside_y;

        wire _unused = &{1'b0, column, row};
    end

    // The number of an orbit: a constant's bits say which shifts of the row are added
    function [ROW_WIDTH-1:0] orbit_of(input [ROW_WIDTH-1:0] row, input [ROW_WIDTH-1:0] column);
        integer place;
        begin
            orbit_of = column;
            for (place = 0; place < ROW_WIDTH; place = place + 1) begin
                if (ORBIT_COLUMNS[place]) begin
                    orbit_of = orbit_of + (row << place);
                end
            end
        end
    endfunction

    // ---- Images: the share of the orbit's taxel in the right quarter of the grid, each from memories of its own
    wire [4*STRESS_BITS-1:0] images_5;
    wire [4*INPUT_BITS-1:0] folded_7;

    genvar image;
    genvar quarter;

    for (image = 0; image < 4; image = image + 1) begin : gen_images
        reg [ROW_WIDTH-1:0] orbit_3;
        reg [1:0] quarter_3;
        reg [1:0] quarter_4;
        reg inside_3;
        reg inside_4;
        wire [STRESS_BITS-1:0] seen_4 [0:3];
        reg [STRESS_BITS-1:0] value_5;

        for (quarter = 0; quarter < 4; quarter = quarter + 1) begin : gen_quarters
            sptfra_ram #(
                .WIDTH         (STRESS_BITS),
                .DEPTH         (SEEN_DEPTH),
                .ADDRESS_WIDTH (ROW_WIDTH)
            ) seen (
                .clock         (clock),
                .write_enable  (share_valid),
                .write_address (share_orbit),
                .write_data    (shares[STRESS_BITS*quarter +: STRESS_BITS]),
                .read_enable   (1'b1),
                .read_address  (orbit_3),
                .read_data     (seen_4[quarter])
            );
        end

        always @(posedge clock) begin
            orbit_3 <= orbit_of(row_2[image / 2], column_2[image % 2]);
            quarter_3 <= {far_y_2[image / 2], far_x_2[image % 2]};
            quarter_4 <= quarter_3;
            inside_3 <= inside_x_2[image % 2] && inside_y_2[image / 2];
            inside_4 <= inside_3;
            value_5 <= inside_4 ? seen_4[quarter_4] : {STRESS_BITS{1'b0}};
        end

        assign images_5[STRESS_BITS*image +: STRESS_BITS] = value_5;
    end

    sptfra_butterfly #(
        .WIDTH (STRESS_BITS)
    ) fold (
        .clock  (clock),
        .enable (1'b1),
        .values (images_5),
        .sums   (folded_7)
    );

    // ---- What goes to the network: the window, then the rest
    wire [INPUT_BITS-1:0] input_mu_x = { {(9 - FINER){mu_x[17]}}, mu_x, {FINER{1'b0}}};
    wire [INPUT_BITS-1:0] input_mu_y = { {(9 - FINER){mu_y[17]}}, mu_y, {FINER{1'b0}}};
    wire [INPUT_BITS-1:0] input_left_x = { {(9 - FINER){left_x[17]}}, left_x, {FINER{1'b0}}};
    wire [INPUT_BITS-1:0] input_left_y = { {(9 - FINER){left_y[17]}}, left_y, {FINER{1'b0}}};
    localparam [INPUT_BITS-1:0] ZERO = {INPUT_BITS{1'b0}};
    reg first_word;
    wire next_word = there[7] || (state == REMAINING);
    wire last_word = (input_word == LAST_BUT_ONE[WORD_WIDTH-1:0]); // the last but one is out

    always @(posedge clock) begin
        input_valid <= next_word;
        input_first <= next_word && first_word;
        done <= (state == REMAINING) && last_word;
        if (next_word) begin
            input_word <= first_word ? {WORD_WIDTH{1'b0}} : input_word + 1'b1;
            first_word <= 1'b0;
        end
        input_values <= folded_7;
        if (state == REMAINING) begin
            if (input_word == LAST_OF_WINDOW[WORD_WIDTH-1:0]) begin
                input_values <= {ZERO, input_mu_y, input_mu_x, INPUT_ONE};
            end else if (input_word == PLACES[WORD_WIDTH-1:0]) begin
                input_values <= {ZERO, input_left_y, input_left_x, ZERO};
            end else begin
                input_values <= {4{ZERO}};
            end
        end
        if (start) begin
            first_word <= 1'b1;
        end
        if (reset) begin
            input_valid <= 1'b0;
            input_first <= 1'b0;
            done <= 1'b0;
        end
    end

    // ---- Sequence
    always @(posedge clock) begin
        wait_count <= wait_count + 3'd1;
        case (state)
            IDLE: begin
                wait_count <= 3'd0;
                if (start) begin
                    state <= CENTRE;
                end
            end
            CENTRE: begin // there after two cycles
                if (wait_count == 3'd1) begin
                    state <= WINDOW;
                end
            end
            WINDOW: begin
                wait_count <= 3'd0;
                if (last_place) begin
                    state <= FLUSH;
                end
            end
            FLUSH: begin // the last place
                if (wait_count == 3'd6) begin
                    state <= REMAINING;
                end
            end
            default: begin
                if (last_word) begin
                    state <= IDLE;
                end
            end
        endcase
        if (reset) begin
            state <= IDLE;
        end
    end

    wire _unused = &{1'b0, shifted_x, shifted_y, centroid_x, centroid_y};

endmodule

`default_nettype wire
