// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// A window of the taxels' shares around the contact, folded into parity classes: the words of the network.
//
// The centroid of the compression, to the next taxel, is the middle of a window of 2 HALF_X + 1 by 2 HALF_Y + 1 taxels.
// A word of four classes for each of its places comes first; then follow 1, mu_x, mu_y and what is left of a pitch. All
// have 19 fraction bits. From start to done: 16 cycles, four for each place, and one for each word behind.

`default_nettype none

module sptfra_look_window #(
    // Taxels along x
    parameter integer COLUMNS = 10,
    // Taxels along y
    parameter integer ROWS = 10,
    // Bits of a taxel's place along x and along y
    parameter integer X_WIDTH = 4,
    parameter integer Y_WIDTH = 4,
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
    // Shares of the taxels
    input  wire share_valid,
    input  wire [Y_WIDTH+X_WIDTH-1:0] share_place, // {y, x}
    input  wire [24:0] share,
    // A new frame; then its centroid is there, the cycle after start, and held
    input  wire clear,
    input  wire start,
    input  wire [23:0] centroid_x, // 16 fraction bits
    input  wire [23:0] centroid_y,
    input  wire signed [17:0] mu_x,
    input  wire signed [17:0] mu_y,
    // Inputs of the network
    output reg  input_valid,
    output reg  [WORD_WIDTH-1:0] input_word,
    output reg  [4*27-1:0] input_values, // class 0 in the lowest bits
    output reg  done // one cycle, with the last of them
);

    localparam integer STRESS_BITS = 25;
    localparam integer INPUT_BITS = STRESS_BITS + 2;
    localparam integer FINER = 3; // bits by which an input is finer than a friction component
    localparam [INPUT_BITS-1:0] INPUT_ONE = 27'd524288;
    // From here on a centre belongs to the next taxel, 16 fraction bits: a little more than half, for ties
    localparam [23:0] CENTRE_HALF = 24'd32832;
    localparam integer PX_WIDTH = (HALF_X < 2) ? 1 : $clog2(HALF_X + 1);
    localparam integer PY_WIDTH = (HALF_Y < 2) ? 1 : $clog2(HALF_Y + 1);
    localparam integer PLACES = (HALF_X + 1) * (HALF_Y + 1);
    localparam integer LAST_OF_WINDOW = PLACES - 1;
    localparam integer LAST_BUT_ONE = LENGTH - 2;
    localparam [9:0] GRID_COLUMNS = COLUMNS[9:0];
    localparam [9:0] GRID_ROWS = ROWS[9:0];

    localparam [1:0] IDLE = 2'd0, FLUSH = 2'd1, WINDOW = 2'd2, REST = 2'd3;

    generate
        if (LENGTH < PLACES + 2) begin : gen_check
            sptfra_error_the_words_do_not_hold_the_window invalid ();
        end
    endgenerate

    reg [1:0] state;
    reg [3:0] wait_count;

    // ---- The taxel next to the centre, and what is left of a pitch
    wire [23:0] shifted_x = centroid_x + CENTRE_HALF;
    wire [23:0] shifted_y = centroid_y + CENTRE_HALF;
    reg signed [9:0] centre_x;
    reg signed [9:0] centre_y;
    reg signed [17:0] left_x;
    reg signed [17:0] left_y;

    always @(posedge clock) begin
        centre_x <= {2'd0, shifted_x[23:16]};
        centre_y <= {2'd0, shifted_y[23:16]};
        left_x <= {2'd0, centroid_x[15:0]} - {1'b0, centre_x[0] ^ centroid_x[16], 16'd0};
        left_y <= {2'd0, centroid_y[15:0]} - {1'b0, centre_y[0] ^ centroid_y[16], 16'd0};
    end

    // ---- Window: four members of each place; beyond the grid, and where members coincide, zero
    reg [1:0] member;
    reg [PX_WIDTH-1:0] place_x;
    reg [PY_WIDTH-1:0] place_y;
    wire reading = (state == WINDOW);
    wire last_place_x = (place_x == HALF_X[PX_WIDTH-1:0]);
    wire last_place = last_place_x && (place_y == HALF_Y[PY_WIDTH-1:0]) && (member == 2'd3);
    wire signed [9:0] distance_x = { {(10 - PX_WIDTH){1'b0}}, place_x};
    wire signed [9:0] distance_y = { {(10 - PY_WIDTH){1'b0}}, place_y};
    reg signed [9:0] at_x;
    reg signed [9:0] at_y;
    reg coincides_1;
    wire inside_x_1 = !at_x[9] && (at_x[8:0] < GRID_COLUMNS[8:0]);
    wire inside_y_1 = !at_y[9] && (at_y[8:0] < GRID_ROWS[8:0]);
    reg inside_2;
    wire [STRESS_BITS-1:0] value_2;
    reg [4*STRESS_BITS-1:0] members_3;
    wire [4*INPUT_BITS-1:0] folded_5;
    reg [5:1] place_ends; // index k: k cycles after the last member's counters

    sptfra_ram #(
        .WIDTH         (STRESS_BITS),
        .DEPTH         (ROWS << X_WIDTH),
        .ADDRESS_WIDTH (Y_WIDTH + X_WIDTH)
    ) seen (
        .clock         (clock),
        .write_enable  (share_valid),
        .write_address (share_place),
        .write_data    (share),
        .read_enable   (1'b1),
        .read_address  ({at_y[Y_WIDTH-1:0], at_x[X_WIDTH-1:0]}),
        .read_data     (value_2)
    );

    sptfra_butterfly #(
        .WIDTH (STRESS_BITS)
    ) fold (
        .clock  (clock),
        .values (members_3),
        .sums   (folded_5)
    );

    always @(posedge clock) begin
        if (reading) begin
            member <= member + 2'd1;
            if (member == 2'd3) begin
                place_x <= last_place_x ? {PX_WIDTH{1'b0}} : place_x + 1'b1;
                place_y <= last_place_x ? place_y + 1'b1 : place_y;
            end
        end else begin
            member <= 2'd0;
            place_x <= {PX_WIDTH{1'b0}};
            place_y <= {PY_WIDTH{1'b0}};
        end
        at_x <= member[0] ? centre_x - distance_x : centre_x + distance_x;
        at_y <= member[1] ? centre_y - distance_y : centre_y + distance_y;
        coincides_1 <= (member[0] && (place_x == {PX_WIDTH{1'b0}})) || (member[1] && (place_y == {PY_WIDTH{1'b0}}));
        inside_2 <= !coincides_1 && inside_x_1 && inside_y_1;
        members_3 <= {inside_2 ? value_2 : {STRESS_BITS{1'b0}}, members_3[4*STRESS_BITS-1:STRESS_BITS]};
        place_ends <= {place_ends[4:1], reading && (member == 2'd3)};
        if (reset) begin
            place_ends <= 5'd0;
        end
    end

    // ---- What goes to the network: the window, then the rest
    wire [INPUT_BITS-1:0] input_mu_x = { {(9 - FINER){mu_x[17]}}, mu_x, {FINER{1'b0}}};
    wire [INPUT_BITS-1:0] input_mu_y = { {(9 - FINER){mu_y[17]}}, mu_y, {FINER{1'b0}}};
    wire [INPUT_BITS-1:0] input_left_x = { {(9 - FINER){left_x[17]}}, left_x, {FINER{1'b0}}};
    wire [INPUT_BITS-1:0] input_left_y = { {(9 - FINER){left_y[17]}}, left_y, {FINER{1'b0}}};
    localparam [INPUT_BITS-1:0] ZERO = {INPUT_BITS{1'b0}};

    reg first_word;
    wire next_word = place_ends[5] || (state == REST);
    wire last_word = (input_word == LAST_BUT_ONE[WORD_WIDTH-1:0]); // the last but one is out

    always @(posedge clock) begin
        input_valid <= next_word;
        done <= (state == REST) && last_word;
        if (next_word) begin
            input_word <= first_word ? {WORD_WIDTH{1'b0}} : input_word + 1'b1;
            first_word <= 1'b0;
        end
        input_values <= folded_5;
        if (state == REST) begin
            if (input_word == LAST_OF_WINDOW[WORD_WIDTH-1:0]) begin
                input_values <= {ZERO, input_mu_y, input_mu_x, INPUT_ONE};
            end else if (input_word == PLACES[WORD_WIDTH-1:0]) begin
                input_values <= {ZERO, input_left_y, input_left_x, ZERO};
            end else begin
                input_values <= {4{ZERO}};
            end
        end
        if (clear) begin
            first_word <= 1'b1;
        end
        if (reset) begin
            input_valid <= 1'b0;
            done <= 1'b0;
        end
    end

    // ---- Sequence
    always @(posedge clock) begin
        wait_count <= wait_count + 4'd1;
        case (state)
            IDLE: begin
                wait_count <= 4'd0;
                if (start) begin
                    state <= FLUSH;
                end
            end
            FLUSH: begin // the centre is there after two cycles, and the window's last place after six
                if (wait_count == 4'd7) begin
                    state <= first_word ? WINDOW : REST;
                end
            end
            WINDOW: begin
                wait_count <= 4'd0;
                if (last_place) begin
                    state <= FLUSH;
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

    wire _unused = &{1'b0, shifted_x, shifted_y, centroid_x, centroid_y, at_x, at_y};

endmodule

`default_nettype wire
